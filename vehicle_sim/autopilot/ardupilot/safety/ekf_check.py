"""Whether the autopilot may trust its estimate: the EKF failsafe and the glitch texts, with ArduCopter's delays."""

from __future__ import annotations

from vehicle_sim.autopilot.ardupilot.modes import MODES, Mode
from vehicle_sim.autopilot.ardupilot.safety.actions import enter_first, pause_landing
from vehicle_sim.autopilot.ardupilot.watched import Watched
from vehicle_sim.autopilot.severity import CRITICAL, WARNING
from vehicle_sim.autopilot.steering import TIME_SLACK_S

PATIENCE_S = 1.0  # bad for this long: failsafe; good for this long: over (ten looks at 10 Hz)
LANE_AFTER_S = 0.9  # just before, the other lane of the EKF is tried
WARNING_PERIOD_S = 30.0
LAND_EVEN_WITHOUT_NEED = 3  # FS_EKF_ACTION
ACTION_MODES = {2: (Mode.ALT_HOLD, Mode.LAND)}  # FS_EKF_ACTION -> modes to try; the others: LAND


class EkfCheck:
    """Watches position and variances once there is a position.

    Attributes:
        active: the estimate is not trusted: no mode that needs a position can be entered.
        lane: which of the two estimators leads.
    """

    def __init__(self) -> None:
        self.active = False
        self.lane = 0
        self._bad_s = 0.0
        self._warned_at_s: float | None = None
        self._looked_at_s = 0.0
        self._acted = False
        self._glitching = False

    def watch(self, pilot: Watched) -> None:
        span_s, self._looked_at_s = pilot.now_s - self._looked_at_s, pilot.now_s
        self._watch_lane(pilot)
        if not pilot.boot.stage.position or (pilot.estimate.exact and not self._bad_s and not self._glitching):
            return
        self._watch_glitch(pilot)
        threshold = pilot.parameters["FS_EKF_THRESH"]
        bad = threshold > 0.0 and (not pilot.estimate.has_position or _over(pilot, threshold))
        if threshold <= 0.0:
            self._bad_s = 0.0
        self._bad_s = max(0.0, min(PATIENCE_S, self._bad_s + (span_s if bad else -span_s)))
        if bad and not self.active:
            self._worsen(pilot)
        elif self.active and self._bad_s <= TIME_SLACK_S:
            self._recover(pilot)

    def _worsen(self, pilot: Watched) -> None:
        if self._bad_s >= LANE_AFTER_S - TIME_SLACK_S and self.lane == 0 and not pilot.estimate.has_position:
            self.lane = 1
            pilot.say(CRITICAL, "EKF3 lane switch 1")
            pilot.say(WARNING, "EKF primary changed:1")
        if self._bad_s < PATIENCE_S - TIME_SLACK_S:
            return
        self.active = pilot.announce = True
        if self._warned_at_s is None or pilot.now_s - self._warned_at_s > WARNING_PERIOD_S:
            self._warned_at_s = pilot.now_s
            pilot.say(CRITICAL, "EKF variance")
        action = int(pilot.parameters["FS_EKF_ACTION"])
        if pilot.armed and (MODES[pilot.mode].needs_position or action == LAND_EVEN_WITHOUT_NEED):
            enter_first(pilot, ACTION_MODES.get(action, (Mode.LAND,)))
            pause_landing(pilot)
            self._acted = True
            pilot.say(CRITICAL, f"EKF Failsafe: changed to {pilot.mode.name} Mode")

    def _recover(self, pilot: Watched) -> None:
        self.active = False
        pilot.announce = True
        if self._acted:
            self._acted = False
            pilot.say(CRITICAL, "EKF Failsafe Cleared")

    def _watch_lane(self, pilot: Watched) -> None:
        """On the ground the first lane leads again."""
        if self.lane != 0 and not pilot.armed and not self.active:
            self.lane = 0
            pilot.say(WARNING, "EKF primary changed:0")

    def _watch_glitch(self, pilot: Watched) -> None:
        if self._glitching is not pilot.estimate.glitching:
            self._glitching = pilot.estimate.glitching
            pilot.say(CRITICAL, "GPS Glitch or Compass error" if self._glitching else "Glitch cleared")


def _over(pilot: Watched, threshold: float) -> bool:
    """ArduCopter's rule: two of compass, velocity and position are bad, or the velocity is twice as bad."""
    velocity, position, _, compass = pilot.estimate.variances
    bad = (compass >= threshold) + (2 if velocity >= 2.0 * threshold else velocity >= threshold)
    return bad >= 2 or (position >= threshold and bad >= 1)
