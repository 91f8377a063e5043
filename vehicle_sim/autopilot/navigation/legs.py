"""The ways of a mission: takeoff, waypoint, loiter, turns, height, delay, land. Each says when it is done.

A return is each flavor's own.
"""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, copysign, cos, hypot, inf, pi, sin

from comms.frames import Vec3
from vehicle_sim.autopilot.mission import Mission
from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.navigation.takeoff import Takeoff
from vehicle_sim.autopilot.plans import commands
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.severity import INFO
from vehicle_sim.autopilot.steering import APPROACH_GAIN_1_S, TIME_SLACK_S, Steering
from vehicle_sim.flight import Demand

LEAST_TAKEOFF_M = 1.0
AT_HEIGHT_M = 0.05
LANDED_AFTER_S = 2.1  # on the ground, before a mission goes on (recorded: the delay of LAND's disarming)
LEAST_TURN_M = 0.1
THROTTLE_MAY_BE_DOWN = 2  # a bit of AUTO_OPTIONS


class Leg(Navigator):
    """One way of a mission.

    Attributes:
        goal_ned_m: where it leads. yaw_rad: where its nose should point, None: as it is.
        lands: it ends on the ground.
    """

    lands = False

    def __init__(self, steering: Steering, now_s: float, item: Item, mission: Mission) -> None:
        super().__init__(steering, now_s)
        self.item = item
        self.mission = mission
        self.index = mission.current
        self.goal_ned_m: Vec3 = steering.ned_from_item(item)
        self.yaw_rad: float | None = None

    def done(self, now_s: float) -> bool:
        return False

    def demand(self, now_s: float) -> Demand | None:
        return self.steering.towards(self.goal_ned_m)

    @property
    def there(self) -> bool:
        """Within WPNAV_RADIUS of the goal."""
        return self.steering.away_m(self.goal_ned_m) < self.steering.reach_m


class TakeoffLeg(Leg):
    """Straight up, once the throttle is up: MISSION_START does that, or a pilot."""

    def __init__(self, steering: Steering, now_s: float, item: Item, mission: Mission) -> None:
        super().__init__(steering, now_s, item, mission)
        lowest_m = LEAST_TAKEOFF_M if steering.airframe.on_ground else 0.0
        self._down_m = min(self.goal_ned_m[2], steering.airframe.down_m - lowest_m)
        self._takeoff: Takeoff | None = None

    @property
    def taking_off(self) -> bool:  # type: ignore[override]
        return self._takeoff is not None and not self._takeoff.done

    def spooled(self, now_s: float) -> bool:
        return self._takeoff is not None and self._takeoff.spooled(now_s)

    def done(self, now_s: float) -> bool:
        return self._takeoff is not None and self._takeoff.done

    def demand(self, now_s: float) -> Demand | None:
        if self._takeoff is None:
            if (
                not self.steering.throttle_up
                and not int(self.steering.parameters["AUTO_OPTIONS"]) & THROTTLE_MAY_BE_DOWN
            ):
                return None
            self._takeoff = Takeoff(self.steering, down_m=self._down_m, now_s=now_s)
        return self._takeoff.demand(now_s)


class WaypointLeg(Leg):
    """To a place, nose ahead, and stay for parameter 1 seconds. Without a stay it goes on, slower round a corner."""

    def __init__(self, steering: Steering, now_s: float, item: Item, mission: Mission) -> None:
        super().__init__(steering, now_s, item, mission)
        self._there_at_s = inf
        self._start_ned_m = steering.place_ned_m
        self._through_m_s = _corner_m_s(steering, self.goal_ned_m, mission) if item.param1 < 1.0 else 0.0
        self.yaw_rad = _ahead_rad(steering, self.goal_ned_m)

    def done(self, now_s: float) -> bool:
        if self.there or self._passed:
            self._there_at_s = min(self._there_at_s, now_s)
        if now_s - self._there_at_s < int(max(0.0, self.item.param1)) - TIME_SLACK_S:
            return False
        self.mission.say(INFO, f"Reached command #{self.index}")
        return True

    def demand(self, now_s: float) -> Demand:
        return self.steering.towards(self.goal_ned_m, through_m_s=self._through_m_s)

    @property
    def _passed(self) -> bool:
        """On the far side of a waypoint that it goes through."""
        if self._through_m_s <= 0.0:
            return False
        places = zip(self._start_ned_m, self.goal_ned_m, self.steering.place_ned_m, strict=True)
        return sum((goal - start) * (here - goal) for start, goal, here in places) >= 0.0


class LoiterLeg(Leg):
    """To a place, and stay: for parameter 1 seconds (LOITER_TIME), or for good."""

    def __init__(self, steering: Steering, now_s: float, item: Item, mission: Mission) -> None:
        super().__init__(steering, now_s, item, mission)
        self._there_at_s = inf
        self._stay_s = item.param1 if item.command == commands.LOITER_TIME else inf
        self.yaw_rad = _ahead_rad(steering, self.goal_ned_m)

    def done(self, now_s: float) -> bool:
        if self.there:
            self._there_at_s = min(self._there_at_s, now_s)
        return now_s - self._there_at_s >= self._stay_s - TIME_SLACK_S


class HeightLeg(Leg):
    """To a place, then up or down to its height."""

    def done(self, now_s: float) -> bool:
        return self._above and abs(self.goal_ned_m[2] - self.steering.airframe.down_m) < AT_HEIGHT_M

    def demand(self, now_s: float) -> Demand:
        demand = self.steering.towards(self.goal_ned_m)
        return demand if self._above else demand._replace(down_m_s=0.0)

    @property
    def _above(self) -> bool:
        return self.steering.distance_m(self.goal_ned_m) < self.steering.reach_m


class TurnsLeg(Leg):
    """Round a place, parameter 1 times, parameter 3 meters away (0: CIRCLE_RADIUS; negative: the other way round)."""

    def __init__(self, steering: Steering, now_s: float, item: Item, mission: Mission) -> None:
        super().__init__(steering, now_s, item, mission)
        radius_m = item.param3 or steering.parameters["CIRCLE_RADIUS"] / 100.0
        self._radius_m = max(LEAST_TURN_M, abs(radius_m))
        self._sense = copysign(1.0, radius_m)
        self._angle_rad = self._bearing_rad()
        self._left_rad = 2.0 * pi * abs(item.param1)
        self._on_edge = False
        self._at_s = now_s

    def done(self, now_s: float) -> bool:
        return self._left_rad <= 0.0

    def demand(self, now_s: float) -> Demand:
        steering, dt_s, self._at_s = self.steering, now_s - self._at_s, now_s
        self.yaw_rad = self._bearing_rad() + pi
        if not self._on_edge:
            edge = self._edge()
            self._on_edge = steering.away_m(edge) < steering.reach_m
            return steering.towards(edge)
        rate_rad_s = abs(steering.parameters["CIRCLE_RATE"]) * pi / 180.0
        rate_rad_s = min(rate_rad_s, steering.airframe.limits.speed_m_s / self._radius_m)
        self._angle_rad += self._sense * rate_rad_s * dt_s
        self._left_rad -= rate_rad_s * dt_s
        edge, speed_m_s = self._edge(), self._sense * rate_rad_s * self._radius_m
        north_m, east_m, _ = steering.place_ned_m
        return Demand(
            -sin(self._angle_rad) * speed_m_s + APPROACH_GAIN_1_S * (edge[0] - north_m),
            cos(self._angle_rad) * speed_m_s + APPROACH_GAIN_1_S * (edge[1] - east_m),
            steering.climb_m_s(edge[2]),
        )

    def _edge(self) -> Vec3:
        north_m, east_m, down_m = self.goal_ned_m
        return (
            north_m + self._radius_m * cos(self._angle_rad),
            east_m + self._radius_m * sin(self._angle_rad),
            down_m,
        )

    def _bearing_rad(self) -> float:
        """From the middle to the vehicle."""
        north_m, east_m, _ = self.steering.place_ned_m
        return atan2(east_m - self.goal_ned_m[1], north_m - self.goal_ned_m[0])


class DelayLeg(Leg):
    """Stay where it is for parameter 1 seconds."""

    def __init__(self, steering: Steering, now_s: float, item: Item, mission: Mission) -> None:
        super().__init__(steering, now_s, item, mission)
        self.goal_ned_m = steering.place_ned_m
        self._until_s = now_s + max(0.0, item.param1)
        mission.say(INFO, f"Delaying {int(max(0.0, item.param1))} sec")

    def done(self, now_s: float) -> bool:
        return now_s >= self._until_s - TIME_SLACK_S


class LandLeg(Leg):
    """To a place at this height, then down. The mission ends there, unless a takeoff comes next."""

    def __init__(self, steering: Steering, now_s: float, item: Item, mission: Mission) -> None:
        super().__init__(steering, now_s, item, mission)
        self.goal_ned_m = (*self.goal_ned_m[:2], steering.airframe.down_m)
        self.landing = False
        self._down_at_s = inf
        after = mission.following_way()
        self.lands = after is None or after.command != commands.TAKEOFF

    def done(self, now_s: float) -> bool:
        if self.landing and self.steering.airframe.on_ground:
            self._down_at_s = min(self._down_at_s, now_s)
        return not self.lands and now_s - self._down_at_s >= LANDED_AFTER_S - TIME_SLACK_S

    def demand(self, now_s: float) -> Demand:
        here = self.steering.towards(self.goal_ned_m)
        self.landing = self.landing or self.there
        return here._replace(down_m_s=self.steering.sink_m_s()) if self.landing else here


BeginLeg = Callable[[Steering, float, Item, Mission], Leg]

LEGS: dict[int, BeginLeg] = {
    commands.WAYPOINT: WaypointLeg,
    commands.SPLINE: WaypointLeg,
    commands.LOITER_UNLIMITED: LoiterLeg,
    commands.LOITER_TIME: LoiterLeg,
    commands.LOITER_TURNS: TurnsLeg,
    commands.LOITER_TO_ALTITUDE: HeightLeg,
    commands.LAND: LandLeg,
    commands.TAKEOFF: TakeoffLeg,
    commands.DELAY: DelayLeg,
}


def _ahead_rad(steering: Steering, goal_ned_m: Vec3) -> float | None:
    """The bearing of a goal that WP_YAW_BEHAVIOR turns the nose to; None if it is too near, or is not to turn."""
    if steering.parameters["WP_YAW_BEHAVIOR"] == 0.0 or steering.distance_m(goal_ned_m) < 2.0:
        return None
    north_m, east_m, _ = steering.place_ned_m
    return atan2(goal_ned_m[1] - east_m, goal_ned_m[0] - north_m)


def _corner_m_s(steering: Steering, goal_ned_m: Vec3, mission: Mission) -> float:
    """How fast to pass a waypoint on the way to the next: the part of the speed limit that points there."""
    after = mission.following_way()
    if after is None or after.command not in (commands.WAYPOINT, commands.SPLINE):
        return 0.0
    start, beyond = steering.place_ned_m, steering.ned_from_item(after, otherwise_ned_m=goal_ned_m)
    first = (goal_ned_m[0] - start[0], goal_ned_m[1] - start[1])
    second = (beyond[0] - goal_ned_m[0], beyond[1] - goal_ned_m[1])
    lengths = hypot(*first) * hypot(*second)
    if lengths <= 0.0:
        return 0.0
    straight = (first[0] * second[0] + first[1] * second[1]) / lengths
    return steering.airframe.limits.speed_m_s * max(0.0, straight)
