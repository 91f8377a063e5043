"""The moves that every mode is made of: towards a place, up or down to a height, round to a heading, down to land.

Positions are reached with ArduPilot's square-root controller: proportional near the goal, constant braking further out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import copysign, cos, dist, hypot, radians, sin, sqrt, tan

from comms.frames import GeoPoint, Vec3
from vehicle_sim.autopilot.estimate import Estimate
from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.plans.place import ned_from_item
from vehicle_sim.autopilot.plans.store import Store
from vehicle_sim.autopilot.rally import refuge_ned_m
from vehicle_sim.autopilot.sticks import NO_RADIO, Sticks
from vehicle_sim.flight import DRAG_1_S, GRAVITY_M_S2, VELOCITY_GAIN_1_S, Demand, wrap_pi

APPROACH_GAIN_1_S = 0.5
APPROACH_BRAKING = 0.8  # of the acceleration limit
CLIMB_GAIN_1_S = 1.0
CLIMB_BRAKING_M_S2 = 0.52  # recorded: v^2 over twice the way left at the end of a takeoff
YAW_GAIN_1_S = 2.0
YAW_RATE_MAX_RAD_S = 1.05
FASTEST_M_S = 100.0
LEAST_REACH_M = 0.05
TIME_SLACK_S = 1e-6  # a clock that counts tenths is never exact


class Steering:
    """One vehicle's moves. Places are north-east-down meters in its own frame; demands are for its airframe.

    Attributes:
        origin: where its frame starts. home_ned_m: where RTL goes; moves with DO_SET_HOME. sticks: what a pilot holds.
        throttle_up: an AUTO takeoff may lift off: somebody said so since it was armed.
        say: a text (severity, words) for the ground.
    """

    def __init__(
        self,
        *,
        airframe: Estimate,
        parameters: Parameters,
        origin: GeoPoint,
        rallies: Store,
        say: Callable[[int, str], None],
    ) -> None:
        self.airframe = airframe
        self.parameters = parameters
        self.say = say
        self.origin = origin
        self._rallies = rallies
        self.throttle_up = False
        self.home_ned_m: Vec3 = (0.0, 0.0, 0.0)
        self.sticks: Sticks = NO_RADIO

    @property
    def place_ned_m(self) -> Vec3:
        frame = self.airframe
        return frame.north_m, frame.east_m, frame.down_m

    @property
    def height_m(self) -> float:
        """Above home."""
        return self.home_ned_m[2] - self.airframe.down_m

    @property
    def reach_m(self) -> float:
        """How near a waypoint is reached."""
        return max(LEAST_REACH_M, self.parameters["WPNAV_RADIUS"] / 100.0)

    def distance_m(self, place_ned_m: Vec3) -> float:
        """Over ground."""
        return hypot(place_ned_m[0] - self.airframe.north_m, place_ned_m[1] - self.airframe.east_m)

    def away_m(self, place_ned_m: Vec3) -> float:
        """Straight through the air."""
        return dist(place_ned_m, self.place_ned_m)

    def stopping_ned_m(self) -> Vec3:
        """Where it would come to rest if it braked now."""
        frame = self.airframe
        speed_m_s = hypot(frame.north_m_s, frame.east_m_s)
        brake_s = speed_m_s / (2.0 * APPROACH_BRAKING * frame.limits.acceleration_m_s2)
        return frame.north_m + frame.north_m_s * brake_s, frame.east_m + frame.east_m_s * brake_s, frame.down_m

    def ned_from_item(self, item: Item, otherwise_ned_m: Vec3 | None = None) -> Vec3:
        """Where an item of a plan is; what it leaves open is as `otherwise_ned_m`, or as here."""
        otherwise = self.place_ned_m if otherwise_ned_m is None else otherwise_ned_m
        return ned_from_item(item, origin=self.origin, home_ned_m=self.home_ned_m, otherwise_ned_m=otherwise)

    def refuge_ned_m(self) -> Vec3:
        """Where a return leads: home or the nearest rally point, at its height."""
        parameters = self.parameters
        return refuge_ned_m(
            self.home_ned_m,
            map(self.ned_from_item, self._rallies.items),
            distance_m=self.distance_m,
            furthest_m=1000.0 * parameters["RALLY_LIMIT_KM"],
            home_counts=parameters["RALLY_INCL_HOME"] == 1.0,
        )

    def change_speed(self, kind: int, speed_m_s: float) -> bool:
        """Another speed limit until the mode or a limit changes: 0 and 1 over ground, 2 climb, 3 descent."""
        field = {0: "speed_m_s", 1: "speed_m_s", 2: "climb_m_s", 3: "descent_m_s"}.get(kind)
        if field is None or not 0.0 < speed_m_s <= FASTEST_M_S:
            return False
        self.airframe.set_limits(replace(self.airframe.limits, **{field: speed_m_s}))
        return True

    def towards(
        self, goal_ned_m: Vec3, *, speed_m_s: float = 0.0, through_m_s: float = 0.0, yaw_rate_rad_s: float = 0.0
    ) -> Demand:
        """Straight to a place, at most at `speed_m_s` over ground (0: the speed limit), there at `through_m_s`."""
        frame = self.airframe
        north, east = goal_ned_m[0] - frame.north_m, goal_ned_m[1] - frame.east_m
        distance_m = hypot(north, east)
        braking_m_s2 = APPROACH_BRAKING * frame.limits.acceleration_m_s2
        speed = approach_m_s(distance_m, gain_1_s=APPROACH_GAIN_1_S, braking_m_s2=braking_m_s2)
        speed = max(speed, through_m_s)
        if speed_m_s > 0.0:
            speed = min(speed, speed_m_s)
        share = speed / distance_m if distance_m > 1e-9 else 0.0
        return Demand(north * share, east * share, self.climb_m_s(goal_ned_m[2]), yaw_rate_rad_s)

    def climb_m_s(self, goal_down_m: float) -> float:
        """The vertical speed (down positive) that brings it to a height."""
        way_m = goal_down_m - self.airframe.down_m
        speed = approach_m_s(abs(way_m), gain_1_s=CLIMB_GAIN_1_S, braking_m_s2=CLIMB_BRAKING_M_S2)
        return copysign(speed, way_m)

    def climb_share_m_s(self, share: float) -> float:
        """The vertical speed (down positive) of a climb asked for from -1 (as fast down as it may) to 1."""
        limits = self.airframe.limits
        return -share * (limits.climb_m_s if share > 0.0 else limits.descent_m_s)

    def pushed_m_s(self, forward_m_s2: float, right_m_s2: float) -> tuple[float, float]:
        """The velocity (north, east) whose pursuit gives such a push, seen from the nose, less what the air takes."""
        north, east = self.turned(forward_m_s2, right_m_s2)
        kept = 1.0 - DRAG_1_S / VELOCITY_GAIN_1_S
        frame = self.airframe
        return kept * frame.north_m_s + north / VELOCITY_GAIN_1_S, kept * frame.east_m_s + east / VELOCITY_GAIN_1_S

    def leaned_m_s(self, roll_rad: float, pitch_rad: float) -> tuple[float, float]:
        """The velocity (north, east) whose pursuit leans it so, within the tilt limit."""
        limit_rad = radians(self.airframe.limits.tilt_deg)
        forward, right = (
            GRAVITY_M_S2 * tan(max(-limit_rad, min(limit_rad, angle_rad))) for angle_rad in (-pitch_rad, roll_rad)
        )
        return self.pushed_m_s(forward, right)

    def turned(self, forward: float, right: float) -> tuple[float, float]:
        """What the nose sees, as north and east."""
        cosine, sine = cos(self.airframe.yaw_rad), sin(self.airframe.yaw_rad)
        return forward * cosine - right * sine, forward * sine + right * cosine

    def sink_m_s(self) -> float:
        """A landing's speed: WPNAV_SPEED_DN (or LAND_SPEED_HIGH) above LAND_ALT_LOW, LAND_SPEED below."""
        slow_m_s = max(0.1, self.parameters["LAND_SPEED"] / 100.0)
        fast_m_s = self.parameters["LAND_SPEED_HIGH"] / 100.0 or self.airframe.limits.descent_m_s
        above_m = self.height_m - max(1.0, self.parameters["LAND_ALT_LOW"] / 100.0)
        braking_m_s = approach_m_s(above_m, gain_1_s=CLIMB_GAIN_1_S, braking_m_s2=CLIMB_BRAKING_M_S2)
        return max(slow_m_s, min(fast_m_s, braking_m_s))

    def turn_rad_s(self, yaw_rad: float | None, yaw_rate_rad_s: float | None = None) -> float:
        """The yaw rate that turns the nose to `yaw_rad`; without one, the rate itself."""
        rate = yaw_rate_rad_s or 0.0
        if yaw_rad is not None:
            rate = YAW_GAIN_1_S * wrap_pi(yaw_rad - self.airframe.yaw_rad)
        return max(-YAW_RATE_MAX_RAD_S, min(YAW_RATE_MAX_RAD_S, rate))


def approach_m_s(distance_m: float, *, gain_1_s: float, braking_m_s2: float) -> float:
    """How fast to approach what is `distance_m` away: ArduPilot's sqrt_controller. Negative distances are reached."""
    if distance_m <= 0.0:
        return 0.0
    linear_m = braking_m_s2 / (gain_1_s * gain_1_s)
    if distance_m <= linear_m:
        return gain_1_s * distance_m
    return sqrt(2.0 * braking_m_s2 * (distance_m - 0.5 * linear_m))
