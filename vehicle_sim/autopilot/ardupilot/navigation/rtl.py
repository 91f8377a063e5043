"""RTL: up to RTL_ALT, home (or to a nearer rally point), wait, down. SMART_RTL ends with the same descent."""

from __future__ import annotations

from enum import Enum, auto

from comms.frames import Vec3
from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import Demand

LOWEST_RETURN_M = 2.0  # above home (RTL_ALT_MIN)
SHALLOWEST_CONE = 0.5  # RTL_CONE_SLOPE below this does not count
CEILING = 1  # a bit of FENCE_TYPE
AT_HOME_M = 0.5
AT_ALTITUDE_M = 0.2


class Return(Enum):
    """The stages of RTL."""

    CLIMB = auto()
    CRUISE = auto()
    LOITER = auto()
    DESCEND = auto()


class ReturnHome(Navigator):
    """Back to home, at a safe height."""

    def __init__(self, steering: Steering, now_s: float) -> None:
        super().__init__(steering, now_s)
        self.stage = Return.CLIMB
        north_m, east_m, down_m = refuge = steering.refuge_ned_m()
        height_m = max(self._height_m(steering, refuge), steering.home_ned_m[2] - down_m)
        self._goal_ned_m: Vec3 = (north_m, east_m, steering.home_ned_m[2] - height_m)
        self._waits_from_s = now_s

    @property
    def landing(self) -> bool:  # type: ignore[override]
        return self.stage is Return.DESCEND and self.steering.parameters["RTL_ALT_FINAL"] <= 0.0

    def demand(self, now_s: float) -> Demand:
        steering, goal = self.steering, self._goal_ned_m
        if self.stage is Return.CLIMB:
            if steering.airframe.down_m > goal[2] + AT_ALTITUDE_M:
                return Demand(down_m_s=steering.climb_m_s(goal[2]))
            self.stage = Return.CRUISE
        if self.stage is Return.CRUISE:
            if steering.distance_m(goal) > AT_HOME_M:
                return steering.towards(goal, speed_m_s=steering.parameters["RTL_SPEED"] / 100.0)
            self.stage = Return.LOITER
            self._waits_from_s = now_s
        if self.stage is Return.LOITER:
            if now_s - self._waits_from_s < steering.parameters["RTL_LOIT_TIME"] / 1000.0:
                return steering.towards(goal)
            self.stage = Return.DESCEND
        return descend(steering, goal)

    @staticmethod
    def _height_m(steering: Steering, refuge_ned_m: Vec3) -> float:
        """Above home: RTL_ALT, in the cone above the goal that RTL_CONE_SLOPE opens, FENCE_MARGIN below the ceiling.

        Never down from here.
        """
        parameters = steering.parameters
        lowest_m = max(LOWEST_RETURN_M, steering.height_m + max(0.0, parameters["RTL_CLIMB_MIN"] / 100.0))
        height_m = max(parameters["RTL_ALT"] / 100.0, lowest_m)
        if parameters["RTL_CONE_SLOPE"] >= SHALLOWEST_CONE:
            cone_m = steering.distance_m(refuge_ned_m) * parameters["RTL_CONE_SLOPE"]
            height_m = min(height_m, max(cone_m, lowest_m))
        if parameters["FENCE_ENABLE"] and int(parameters["FENCE_TYPE"]) & CEILING:
            height_m = min(height_m, parameters["FENCE_ALT_MAX"] - parameters["FENCE_MARGIN"])
        return max(height_m, steering.height_m)


def descend(steering: Steering, goal_ned_m: Vec3) -> Demand:
    """Down above `goal_ned_m`: to RTL_ALT_FINAL, or (0) to the ground."""
    north_m, east_m, _ = goal_ned_m
    final_m = steering.parameters["RTL_ALT_FINAL"] / 100.0
    if final_m > 0.0:
        return steering.towards((north_m, east_m, steering.home_ned_m[2] - final_m))
    return steering.towards(goal_ned_m)._replace(down_m_s=steering.sink_m_s())
