"""The fence: a ceiling, a floor, a circle around home and what was uploaded; and what happens to who crosses it."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntFlag
from math import hypot

from comms.frames import Vec3
from vehicle_sim.autopilot.ardupilot.modes import Mode
from vehicle_sim.autopilot.ardupilot.safety.actions import Action, act
from vehicle_sim.autopilot.ardupilot.watched import Watched
from vehicle_sim.autopilot.outline import Outline, outline
from vehicle_sim.autopilot.plans.store import Store
from vehicle_sim.autopilot.severity import NOTICE

NO_DEPTH_M = 0.01  # how far a place is inside or outside a polygon: nobody measures
GIVE_UP_M = 100.0  # further out than this it lands where it is
AGAIN_M = 20.0  # further out, and a breach counts again ...
RECOVERY_S = 10.0  # ... unless the mode was changed this short ago: somebody is at it


class Border(IntFlag):
    """The bits of FENCE_TYPE."""

    NONE = 0
    ALT_MAX = 1
    CIRCLE = 2
    POLYGON = 4
    ALT_MIN = 8


NAMES = {Border.ALT_MAX: "Max Alt", Border.CIRCLE: "Circle", Border.POLYGON: "Polygon", Border.ALT_MIN: "Min Alt"}

# FENCE_ACTION -> what to do; values that are not here do nothing.
FENCE_ACTIONS: dict[int, Action] = {
    1: Action.RTL,
    2: Action.LAND,
    3: Action.SMART_RTL_OR_RTL,
    4: Action.BRAKE_OR_LAND,
    5: Action.SMART_RTL_OR_LAND,
}


class Fence:
    """One vehicle's fences.

    Attributes:
        breached: the borders it is beyond. breaches: how often one was crossed. last, breached_at_s: the last crossing.
    """

    def __init__(self, store: Store) -> None:
        self._store = store
        self._version = -1
        self._outline = Outline()
        self._again_m: dict[Border, float] = {}
        self._mode: Mode | None = None
        self._recovers_until_s = 0.0
        self.breached = Border.NONE
        self.last = Border.NONE
        self.breaches = 0
        self.breached_at_s = 0.0

    def allows(self, pilot: Watched, place_ned_m: Vec3) -> bool:
        """Whether a place is on the right side of all borders that are switched on."""
        return all(out_m <= 0.0 for out_m in self._out_m(pilot, place_ned_m).values())

    def beyond_m(self, pilot: Watched) -> dict[Border, float]:
        """How far it is beyond each border that is switched on; only those that it is beyond."""
        out_m = self._out_m(pilot, pilot.steering.place_ned_m) if pilot.has_position else {}
        return {border: beyond_m for border, beyond_m in out_m.items() if beyond_m >= 0.0}

    def _out_m(self, pilot: Watched, place_ned_m: Vec3) -> dict[Border, float]:
        """How far a place is beyond each border that is switched on; negative: inside. A polygon has no depth."""
        parameters = pilot.parameters
        if not parameters["FENCE_ENABLE"]:
            return {}
        if self._version != self._store.version:
            self._version = self._store.version
            self._outline = outline(self._store.items, pilot.steering.ned_from_item)
        north_m, east_m, down_m = place_ned_m
        home_north_m, home_east_m, home_down_m = pilot.steering.home_ned_m
        height_m = home_down_m - down_m
        out_m = {
            Border.ALT_MAX: height_m - parameters["FENCE_ALT_MAX"],
            Border.CIRCLE: hypot(north_m - home_north_m, east_m - home_east_m) - parameters["FENCE_RADIUS"],
            Border.POLYGON: -NO_DEPTH_M if self._outline.allows(north_m, east_m) else NO_DEPTH_M,
            Border.ALT_MIN: parameters["FENCE_ALT_MIN"] - height_m,
        }
        switched_on = int(parameters["FENCE_TYPE"])
        return {border: beyond_m for border, beyond_m in out_m.items() if border & switched_on}

    def watch(self, pilot: Watched) -> None:
        """Look once: say and do what a new crossing asks for, and say when it is over."""
        if pilot.mode is not self._mode:
            self._mode = pilot.mode
            self._recovers_until_s = pilot.now_s + RECOVERY_S if self.breached else 0.0
        beyond = self.beyond_m(pilot)
        if not beyond and not self.breached:
            return
        before, self.breached = self.breached, Border(sum(beyond))
        recovering = pilot.now_s < self._recovers_until_s
        new = {
            border: out_m
            for border, out_m in beyond.items()
            if border not in before or (out_m > self._again_m.get(border, out_m) and not recovering)
        }
        if new:
            self._cross(pilot, new)
        elif before and not self.breached and pilot.flying:
            pilot.say(NOTICE, "Fence breach cleared")

    def _cross(self, pilot: Watched, new: dict[Border, float]) -> None:
        self.last, self.breached_at_s = max(new), pilot.now_s
        self.breaches += 1
        self._again_m |= {border: out_m + AGAIN_M for border, out_m in new.items()}
        if not pilot.armed:
            return
        if pilot.flying:
            pilot.say(NOTICE, f"{named(new)} fence breached")
        action = FENCE_ACTIONS.get(int(pilot.parameters["FENCE_ACTION"]))
        if action is None:
            return
        falls = pilot.mode is Mode.STABILIZE and pilot.guidance.steering.sticks.throttle == 0.0
        if not pilot.flying or (falls and Border.ALT_MAX not in self.breached):
            pilot.disarm(forced=True)
        else:
            act(pilot, Action.LAND if max(new.values()) > GIVE_UP_M else action)
        self._mode = pilot.mode  # its own change is nobody's recovery


def named(borders: Iterable[Border]) -> str:
    """The borders as a text names them."""
    return " and ".join(NAMES[border] for border in borders)
