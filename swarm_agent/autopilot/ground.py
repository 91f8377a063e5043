"""The first stages: from no heartbeat to climbing."""

from __future__ import annotations

from comms.status import Level
from swarm_agent.autopilot.airborne import OnLayer, TakenOver, interruption, on_layer
from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.ending import Descent, Done, Failed
from swarm_agent.autopilot.errand import Errand, Progress
from swarm_agent.autopilot.flavors import FLAVORS, known_flavors
from swarm_agent.autopilot.intent import Intent, Land, Return
from swarm_agent.autopilot.preflight import Checklist, layer_misfit
from swarm_agent.autopilot.requests import arm, take_off
from swarm_agent.autopilot.stage import OnTheWay, Stage
from swarm_agent.autopilot.state import Phase

LIFTED_M = 0.5  # higher than this above where it stood: off the ground, whatever the landed state says yet
LIFT_OFF_S = 6.0  # an accepted takeoff that has not lifted off after this long is asked for again
HOMING_CONNECT_S = 3.0  # whoever begins anew when all come home has a vehicle that may be heard
STALLED_M_S = 0.15
STALLED_S = 3.0  # a climb that has stood still for so long below the layer is finished by setpoints


class Connect(OnTheWay):
    """Wait for the vehicle's first heartbeat; learn from it what kind of autopilot it is."""

    phase = Phase.CONNECT

    def __init__(self) -> None:
        self._since_s: float | None = None

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Listen."""
        if self._since_s is None:
            self._since_s = now_s
        telemetry, config = cockpit.telemetry, cockpit.config
        if telemetry.autopilot is None:
            waited_s = now_s - self._since_s
            limit_s = HOMING_CONNECT_S if isinstance(intent, Return | Land) else config.connect_limit_s
            if waited_s > limit_s:
                who = "any autopilot" if config.system_id is None else f"system {config.system_id}"
                return Failed(f"no heartbeat from {who} in {waited_s:.0f} s")
            return self
        flavor = FLAVORS.get(telemetry.autopilot)
        if flavor is None:
            return Failed(f"MAV_AUTOPILOT {telemetry.autopilot} is not supported, only {known_flavors()}")
        cockpit.flavor = flavor
        cockpit.say(Level.INFO, f"heartbeat of an {flavor.name} vehicle, system {cockpit.system_id}")
        return Preflight(since_s=now_s)


class Preflight(OnTheWay):
    """Work through the checklist. A vehicle found in the air (the agent was restarted) is flown on if it is guided."""

    phase = Phase.PREFLIGHT

    def __init__(self, *, since_s: float) -> None:
        self._since_s = since_s
        self._checklist = Checklist()

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Go on with the checklist."""
        telemetry, config = cockpit.telemetry, cockpit.config
        flown = telemetry.armed and telemetry.landed is False
        if isinstance(intent, Return | Land):
            if flown and not cockpit.in_mode(cockpit.flavor.guided):
                return TakenOver(cockpit)
            return Descent(on_the_spot=isinstance(intent, Land)) if telemetry.armed else Done()
        self._checklist.tick(cockpit, now_s, flown=flown)
        if self._checklist.failure:
            return Failed(self._checklist.failure)
        if self._checklist.passed:
            if not flown:
                return Arm(since_s=now_s)
            cockpit.say(Level.WARNING, "found in the air")
            return OnLayer() if cockpit.in_mode(cockpit.flavor.guided) else TakenOver(cockpit)
        if now_s - self._since_s > config.preflight_limit_s:
            words = f" ({cockpit.last_warning})" if cockpit.last_warning else ""
            return Failed(f"{self._checklist.waiting_for} after {config.preflight_limit_s:g} s{words}")
        return self


class Arm(OnTheWay):
    """Start the motors."""

    phase = Phase.ARM

    def __init__(self, *, since_s: float) -> None:
        self._since_s = since_s
        self._errand: Errand | None = None

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Ask until the heartbeat says armed."""
        telemetry, config = cockpit.telemetry, cockpit.config
        if isinstance(intent, Return | Land):
            return Descent() if telemetry.armed else Done()
        if telemetry.position_m is None or not cockpit.in_mode(cockpit.flavor.arms_in):
            return Preflight(since_s=self._since_s)
        if self._errand is None:
            limit_s = config.refusal_limit_s - (now_s - self._since_s)
            self._errand = Errand(arm(), limit_s=limit_s, done=lambda telemetry: telemetry.armed)
        progress = self._errand.tick(cockpit, now_s)
        if progress is Progress.GIVEN_UP:
            return Failed(self._errand.reason)
        if progress is Progress.DONE:
            ground_up_m = telemetry.position_m[2]
            misfit = layer_misfit(config, ground_up_m=ground_up_m)  # its origin may have moved since the checklist
            return Failed(misfit) if misfit else Takeoff(since_s=self._since_s, ground_up_m=ground_up_m)
        return self


class Takeoff(OnTheWay):
    """Climb to the layer. The autopilot does it alone: a recorded ArduCopter ignored setpoints until its climb ended.

    Args:
        since_s: when arming began: the limit on refusals counts from there.
        ground_up_m: where the vehicle stands, up in the mission's frame.
    """

    phase = Phase.TAKEOFF

    def __init__(self, *, since_s: float, ground_up_m: float) -> None:
        self._since_s = since_s
        self._ground_up_m = ground_up_m
        self._errand: Errand | None = None
        self._accepted_at_s: float | None = None
        self._rising_at_s: float | None = None

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Ask for the takeoff, then watch the climb."""
        telemetry = cockpit.telemetry
        if telemetry.landed and not telemetry.armed and not isinstance(intent, Return | Land):
            cockpit.say(Level.WARNING, "disarmed before takeoff: arming again")
            return Arm(since_s=self._since_s)
        stage = interruption(cockpit, now_s, intent, ours=cockpit.flavor.climbs_in)
        if stage is not None:
            return stage
        position_m = telemetry.position_m
        if position_m is not None and position_m[2] - self._ground_up_m > LIFTED_M:
            return self._climb(cockpit, now_s, position_m[2])
        return self._lift_off(cockpit, now_s)

    def _lift_off(self, cockpit: Cockpit, now_s: float) -> Stage:
        if self._accepted_at_s is not None:
            if now_s - self._accepted_at_s < LIFT_OFF_S:
                return self
            self._accepted_at_s = self._errand = None
            cockpit.say(Level.WARNING, f"not off the ground {LIFT_OFF_S:g} s after the takeoff was accepted")
        limit_s = cockpit.config.refusal_limit_s - (now_s - self._since_s)
        if self._errand is None:
            self._errand = Errand(take_off(self.altitude_m(cockpit)), limit_s=limit_s)
        progress = self._errand.tick(cockpit, now_s)
        if progress is Progress.GIVEN_UP or limit_s <= 0.0:
            return Failed(self._errand.reason or "does not lift off", bring_down=True)
        if progress is Progress.DONE:
            self._accepted_at_s = now_s
        return self

    def _climb(self, cockpit: Cockpit, now_s: float, up_m: float) -> Stage:
        config, velocity_m_s = cockpit.config, cockpit.telemetry.velocity_m_s
        if abs(up_m - config.altitude_m) <= config.layer_tolerance_m:
            return on_layer(cockpit)
        if self._rising_at_s is None or (velocity_m_s is not None and abs(velocity_m_s[2]) > STALLED_M_S):
            self._rising_at_s = now_s
        if now_s - self._rising_at_s > STALLED_S:
            cockpit.say(
                Level.WARNING, f"takeoff stopped at {up_m:.1f} m of {config.altitude_m:.1f} m: going on by setpoints"
            )
            return on_layer(cockpit)
        return self

    def altitude_m(self, cockpit: Cockpit) -> float:
        """The layer in the frame the flavor's NAV_TAKEOFF counts in; the vehicle stands at its home."""
        config = cockpit.config
        if cockpit.flavor.takeoff_is_amsl:
            return config.home.altitude_m + config.altitude_m
        return config.altitude_m - self._ground_up_m
