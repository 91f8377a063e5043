"""The checklist between the first heartbeat and arming: what must be true, in order, and what is done about it."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot

from comms.status import Level
from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.config import PilotConfig
from swarm_agent.autopilot.errand import Errand, Progress
from swarm_agent.autopilot.requests import Request, WriteAltitude, set_mode, tell_origin
from swarm_agent.autopilot.telemetry import Telemetry

LOWEST_LAYER_M = 1.0  # a layer lower than this above the vehicle's ground cannot be meant
HIGHEST_LAYER_M = 1000.0
ALTITUDE_DRIFT_M = 1.0  # what a standing vehicle's altitude may drift before the return altitude is set anew
PARAMETER_LIMIT_S = 5.0  # for one name; then the next name is tried


class Checklist:
    """The items in order; an item that comes undone (the vehicle restarted) is done again.

    Attributes:
        passed: every item is done. waiting_for: the first that is not, in words.
        failure: why the vehicle will never pass, else empty.
    """

    def __init__(self) -> None:
        self.passed = False
        self.waiting_for = ""
        self.failure = ""
        self._errand: Errand | None = None
        self._errand_for = ""
        self._names_tried = 0
        self._return_altitude_m: float | None = None
        self._return_written = False

    def tick(self, cockpit: Cockpit, now_s: float, *, flown: bool) -> None:
        """Check from the top, and work on the first item that is open. `flown`: in the air, so less is needed."""
        for item in ITEMS_IN_AIR if flown else ITEMS:
            waiting_for = item(self, cockpit, now_s)
            if waiting_for or self.failure:
                self._wait(cockpit, waiting_for)
                return
        self.passed = True

    def _wait(self, cockpit: Cockpit, waiting_for: str) -> None:
        if waiting_for and waiting_for != self.waiting_for:
            cockpit.say(Level.INFO, waiting_for)
        self.waiting_for = waiting_for

    def _run(self, cockpit: Cockpit, now_s: float, request: Request, *, limit_s: float,
             done: Callable[[Telemetry], bool] | None = None) -> Progress:  # fmt: skip
        """Go on with the errand for this request, the one that is under way or a new one."""
        if self._errand is None or self._errand_for != request.name:
            self._errand, self._errand_for = Errand(request, limit_s=limit_s, done=done), request.name
        errand = self._errand
        progress = errand.tick(cockpit, now_s)
        if progress is not Progress.OPEN:
            self._errand = None
        if progress is Progress.GIVEN_UP:
            self.failure = errand.reason
        return progress

    def rates(self, cockpit: Cockpit, now_s: float) -> str:
        """The vehicle sends what we need (the pilot asks for it all along)."""
        return "" if cockpit.rates_asked else "asking for telemetry"

    def position(self, cockpit: Cockpit, now_s: float) -> str:
        """The vehicle knows where it is: it sends LOCAL_POSITION_NED and its estimator agrees."""
        telemetry = cockpit.telemetry
        return "" if telemetry.local_enu_m is not None and telemetry.has_fix else "waiting for a position"

    def origin(self, cockpit: Cockpit, now_s: float) -> str:
        """The vehicle's own frame has a place in the mission's, near enough to be the same mission."""
        telemetry, config = cockpit.telemetry, cockpit.config
        if telemetry.origin_m is None or not telemetry.frames_agree:
            self._run(cockpit, now_s, tell_origin(), limit_s=config.refusal_limit_s, done=_has_place)
            return "asking for the origin of its local frame"
        offset_m = hypot(telemetry.origin_m[0], telemetry.origin_m[1])
        if offset_m > config.max_offset_m:
            self.failure = f"{offset_m / 1000.0:.1f} km from the mission's home: wrong home or wrong vehicle"
        return ""

    def return_altitude(self, cockpit: Cockpit, now_s: float) -> str:
        """The vehicle returns at its own layer, where no other one flies."""
        altitude_m = self._layer_above_ground(cockpit)
        if self._return_altitude_m is None or abs(altitude_m - self._return_altitude_m) > ALTITUDE_DRIFT_M:
            self._return_altitude_m, self._return_written = altitude_m, False
        if self._return_written or self.failure:
            return ""
        names = cockpit.flavor.return_altitude
        request = WriteAltitude(names[self._names_tried], self._return_altitude_m)
        last = self._names_tried == len(names) - 1
        limit_s = cockpit.config.refusal_limit_s if last else PARAMETER_LIMIT_S
        progress = self._run(cockpit, now_s, request, limit_s=limit_s)
        if progress is Progress.DONE:
            self._return_written = True
            return ""
        if progress is Progress.GIVEN_UP and not last:
            self._names_tried += 1
            self.failure = ""
        return "setting its return altitude"

    def _layer_above_ground(self, cockpit: Cockpit) -> float:
        position_m, config = cockpit.telemetry.position_m, cockpit.config
        ground_up_m = position_m[2] if position_m is not None else 0.0
        self.failure = layer_misfit(config, ground_up_m=ground_up_m)
        return config.altitude_m - ground_up_m

    def checks(self, cockpit: Cockpit, now_s: float) -> str:
        """The vehicle's own pre-arm checks pass, which look at its mode, too; its reasons come as texts."""
        return "" if cockpit.telemetry.prearm_ok else "waiting for the pre-arm checks"

    def guided(self, cockpit: Cockpit, now_s: float) -> str:
        """The vehicle is in the mode it takes off from: it listens to us."""
        mode = cockpit.flavor.arms_in
        if cockpit.in_mode(mode):
            return ""
        limit_s = cockpit.config.refusal_limit_s
        self._run(cockpit, now_s, set_mode(mode), limit_s=limit_s, done=lambda _: cockpit.in_mode(mode))
        return f"switching to {mode.name}"


def layer_misfit(config: PilotConfig, *, ground_up_m: float) -> str:
    """Why no vehicle that stands at `ground_up_m` can be meant to climb to the layer; empty if it can."""
    above_m = config.altitude_m - ground_up_m
    if LOWEST_LAYER_M <= above_m <= HIGHEST_LAYER_M:
        return ""
    return (
        f"the layer at {config.altitude_m:g} m is {above_m:.1f} m above this vehicle's ground: "
        f"does the mission's home altitude ({config.home.altitude_m:g} m) fit?"
    )


def _has_place(telemetry: Telemetry) -> bool:
    return telemetry.origin_m is not None and telemetry.frames_agree


Item = Callable[[Checklist, Cockpit, float], str]  # what it waits for; empty when done

ITEMS_IN_AIR: tuple[Item, ...] = (Checklist.rates, Checklist.position, Checklist.origin)
ITEMS: tuple[Item, ...] = (*ITEMS_IN_AIR, Checklist.return_altitude, Checklist.guided, Checklist.checks)
