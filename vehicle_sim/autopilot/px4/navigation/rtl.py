"""RTL: up to RTL_RETURN_ALT (near home, less), home or to a rally point, down to RTL_DESCEND_ALT, wait, land."""

from __future__ import annotations

from enum import Enum, auto
from math import radians, tan

from comms.frames import Vec3
from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.steering import TIME_SLACK_S, Steering
from vehicle_sim.flight import Demand

AT_HOME_M = 0.5
AT_ALTITUDE_M = 0.2


class Stage(Enum):
    """What a return does now."""

    CLIMB = auto()
    CRUISE = auto()
    DESCEND = auto()
    WAIT = auto()
    LAND = auto()


class Return(Navigator):
    """One return, which ends on the ground."""

    lands = True

    def __init__(self, steering: Steering, now_s: float) -> None:
        super().__init__(steering, now_s)
        self.stage = Stage.CLIMB
        north_m, east_m, down_m = goal = steering.refuge_ned_m()
        self._above_ned_m: Vec3 = (north_m, east_m, down_m - _return_height_m(steering, goal))
        descent_m = max(0.0, steering.parameters["RTL_DESCEND_ALT"])
        self._wait_ned_m: Vec3 = (north_m, east_m, max(down_m - descent_m, self._above_ned_m[2]))
        self._waits_from_s = now_s

    @property
    def landing(self) -> bool:  # type: ignore[override]
        return self.stage is Stage.LAND

    def demand(self, now_s: float) -> Demand:
        self._go_on(now_s)
        steering, above = self.steering, self._above_ned_m
        if self.stage is Stage.CLIMB:
            return Demand(down_m_s=steering.climb_m_s(above[2]))
        if self.stage is Stage.CRUISE:
            return steering.towards(above)
        if self.stage is Stage.LAND:
            return steering.towards(above)._replace(down_m_s=steering.sink_m_s())
        return steering.towards(self._wait_ned_m)

    def _go_on(self, now_s: float) -> None:
        """On to the next stage when this one is done."""
        steering, down_m = self.steering, self.steering.airframe.down_m
        if self.stage is Stage.CLIMB and down_m <= self._above_ned_m[2] + AT_ALTITUDE_M:
            self.stage = Stage.CRUISE
        if self.stage is Stage.CRUISE and steering.distance_m(self._above_ned_m) <= AT_HOME_M:
            self.stage = Stage.DESCEND
        if self.stage is Stage.DESCEND and down_m >= self._wait_ned_m[2] - AT_ALTITUDE_M:
            self.stage, self._waits_from_s = Stage.WAIT, now_s
        delay_s = steering.parameters["RTL_LAND_DELAY"]
        if self.stage is Stage.WAIT and 0.0 <= delay_s <= now_s - self._waits_from_s + TIME_SLACK_S:
            self.stage = Stage.LAND


def _return_height_m(steering: Steering, goal_ned_m: Vec3) -> float:
    """Above the goal: RTL_RETURN_ALT, in the cone that RTL_CONE_ANG opens above it; never down from here."""
    parameters = steering.parameters
    here_m, away_m = goal_ned_m[2] - steering.airframe.down_m, steering.distance_m(goal_ned_m)
    height_m, descend_m = parameters["RTL_RETURN_ALT"], parameters["RTL_DESCEND_ALT"]
    half_angle_deg = parameters["RTL_CONE_ANG"]
    if away_m <= parameters["RTL_MIN_DIST"]:
        height_m = descend_m
    elif 0.0 < half_angle_deg < 90.0:
        height_m = max(descend_m, min(height_m, away_m / tan(radians(half_angle_deg))))
    return max(height_m, here_m, 0.0)
