"""From the flight mode to a velocity demand: takeoff, setpoints and their expiry, return, land.

Positions are reached with ArduPilot's square-root controller: proportional near the goal, constant braking further out.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum, auto
from math import copysign, hypot, sqrt

from vehicle_sim.autopilot.modes import Mode
from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.autopilot.setpoints import STOP, Setpoint
from vehicle_sim.flight import Airframe, Demand, wrap_pi

SPOOL_UP_S = 1.0  # from the takeoff command to the first lift (recorded)
TAKEN_OFF_M = 0.1  # below the takeoff altitude: done
AT_HOME_M = 0.5
AT_ALTITUDE_M = 0.2
APPROACH_GAIN_1_S = 0.5
APPROACH_BRAKING = 0.8  # of the acceleration limit
CLIMB_GAIN_1_S = 1.0
CLIMB_BRAKING_M_S2 = 0.52  # recorded: v^2 over twice the way left at the end of a takeoff
YAW_GAIN_1_S = 2.0
YAW_RATE_MAX_RAD_S = 1.05
TIME_SLACK_S = 1e-6  # a clock that counts tenths is never exact


class Return(Enum):
    """The stages of RTL."""

    CLIMB = auto()
    CRUISE = auto()
    LOITER = auto()
    DESCEND = auto()


class Guidance:
    """What one vehicle is doing about its mode. `demand` is asked once a physics step while armed."""

    def __init__(self, *, airframe: Airframe, parameters: Parameters) -> None:
        self._airframe = airframe
        self._parameters = parameters
        self.setpoint = STOP
        self.taking_off = False
        self.rtl_stage = Return.CLIMB
        self._mode = Mode.STABILIZE
        self._setpoint_at_s = 0.0
        self._spooled_at_s = 0.0
        self._goal_m = (0.0, 0.0, 0.0)
        self._loiter_from_s = 0.0
        self._flown: dict[Mode, Callable[[float], Demand | None]] = {
            Mode.STABILIZE: lambda now_s: None,
            Mode.GUIDED: self._guided,
            Mode.RTL: self._return,
            Mode.LAND: lambda now_s: self._land(),
            Mode.BRAKE: lambda now_s: Demand(),
        }

    def enter(self, mode: Mode) -> None:
        """Begin `mode`: whatever was flown before is forgotten; GUIDED and BRAKE stop."""
        self._mode = mode
        self.setpoint = STOP
        self.taking_off = False
        self.rtl_stage = Return.CLIMB
        height_m = -self._airframe.down_m
        self._goal_m = (0.0, 0.0, -max(height_m, self._parameters["RTL_ALT"] / 100.0))

    def take_off(self, altitude_m: float, now_s: float) -> None:
        """Climb to `altitude_m` above home, straight up."""
        self.taking_off = True
        self._spooled_at_s = now_s + SPOOL_UP_S
        self._goal_m = (self._airframe.north_m, self._airframe.east_m, -altitude_m)

    def follow(self, setpoint: Setpoint, now_s: float) -> None:
        """A GUIDED setpoint. On the ground and during a takeoff it is ignored, as ArduCopter does."""
        if self._mode is Mode.GUIDED and not self.taking_off and not self._airframe.on_ground:
            self.setpoint = setpoint
            self._setpoint_at_s = now_s

    def demand(self, now_s: float) -> Demand | None:
        """What to fly over the step that begins now; None: motors idle."""
        if self.taking_off:
            return self._take_off(now_s)
        if self._airframe.on_ground:
            return None
        return self._flown[self._mode](now_s)

    def spooled(self, now_s: float) -> bool:
        """Whether a takeoff is past its spool-up: the autopilot counts as flying from here on."""
        return self.taking_off and now_s >= self._spooled_at_s - TIME_SLACK_S

    @property
    def landing(self) -> bool:
        return self._mode is Mode.LAND or (self._mode is Mode.RTL and self.rtl_stage is Return.DESCEND)

    def _take_off(self, now_s: float) -> Demand | None:
        if not self.spooled(now_s):
            return None
        if self._airframe.down_m - self._goal_m[2] < TAKEN_OFF_M:
            self.taking_off = False
            self.setpoint = Setpoint(position_ned_m=self._goal_m)
        return self._toward(self._goal_m)

    def _guided(self, now_s: float) -> Demand:
        position, velocity, yaw_rad, yaw_rate = self.setpoint
        if position is not None:
            return self._toward(position, yaw_rate_rad_s=self._turn(yaw_rad, yaw_rate))
        if velocity is None or now_s - self._setpoint_at_s >= self._parameters["GUID_TIMEOUT"] - TIME_SLACK_S:
            return Demand()
        return Demand(*velocity, self._turn(yaw_rad, yaw_rate))

    def _return(self, now_s: float) -> Demand | None:
        frame, goal = self._airframe, self._goal_m
        if self.rtl_stage is Return.CLIMB:
            if -frame.down_m < -goal[2] - AT_ALTITUDE_M:
                return Demand(down_m_s=self._climb(goal[2]))
            self.rtl_stage = Return.CRUISE
        if self.rtl_stage is Return.CRUISE:
            if hypot(frame.north_m, frame.east_m) > AT_HOME_M:
                return self._toward(goal, speed_m_s=self._parameters["RTL_SPEED"] / 100.0)
            self.rtl_stage = Return.LOITER
            self._loiter_from_s = now_s
        if self.rtl_stage is Return.LOITER:
            if now_s - self._loiter_from_s < self._parameters["RTL_LOIT_TIME"] / 1000.0:
                return self._toward(goal)
            self.rtl_stage = Return.DESCEND
        if self._parameters["RTL_ALT_FINAL"] > 0.0:
            return self._toward((0.0, 0.0, -self._parameters["RTL_ALT_FINAL"] / 100.0))
        return self._toward((0.0, 0.0, 0.0))._replace(down_m_s=self._land().down_m_s)

    def _land(self) -> Demand:
        """Down at WPNAV_SPEED_DN (or LAND_SPEED_HIGH) above LAND_ALT_LOW, at LAND_SPEED below, braking in between."""
        slow_m_s = max(0.1, self._parameters["LAND_SPEED"] / 100.0)
        fast_m_s = self._parameters["LAND_SPEED_HIGH"] / 100.0 or self._airframe.limits.descent_m_s
        above_m = -self._airframe.down_m - max(1.0, self._parameters["LAND_ALT_LOW"] / 100.0)
        braking_m_s = approach_m_s(above_m, gain_1_s=CLIMB_GAIN_1_S, braking_m_s2=CLIMB_BRAKING_M_S2)
        return Demand(down_m_s=max(slow_m_s, min(fast_m_s, braking_m_s)))

    def _toward(
        self, goal_m: tuple[float, float, float], *, speed_m_s: float = 0.0, yaw_rate_rad_s: float = 0.0
    ) -> Demand:
        """Straight to a place in the local frame, at most at `speed_m_s` over ground (0: the speed limit)."""
        frame = self._airframe
        north, east = goal_m[0] - frame.north_m, goal_m[1] - frame.east_m
        distance_m = hypot(north, east)
        braking_m_s2 = APPROACH_BRAKING * frame.limits.acceleration_m_s2
        speed = approach_m_s(distance_m, gain_1_s=APPROACH_GAIN_1_S, braking_m_s2=braking_m_s2)
        if speed_m_s > 0.0:
            speed = min(speed, speed_m_s)
        share = speed / distance_m if distance_m > 1e-9 else 0.0
        return Demand(north * share, east * share, self._climb(goal_m[2]), yaw_rate_rad_s)

    def _climb(self, goal_down_m: float) -> float:
        way_m = goal_down_m - self._airframe.down_m
        speed = approach_m_s(abs(way_m), gain_1_s=CLIMB_GAIN_1_S, braking_m_s2=CLIMB_BRAKING_M_S2)
        return copysign(speed, way_m)

    def _turn(self, yaw_rad: float | None, yaw_rate_rad_s: float | None) -> float:
        rate = yaw_rate_rad_s or 0.0
        if yaw_rad is not None:
            rate = YAW_GAIN_1_S * wrap_pi(yaw_rad - self._airframe.yaw_rad)
        return max(-YAW_RATE_MAX_RAD_S, min(YAW_RATE_MAX_RAD_S, rate))


def approach_m_s(distance_m: float, *, gain_1_s: float, braking_m_s2: float) -> float:
    """How fast to approach what is `distance_m` away: ArduPilot's sqrt_controller. Negative distances are reached."""
    if distance_m <= 0.0:
        return 0.0
    linear_m = braking_m_s2 / (gain_1_s * gain_1_s)
    if distance_m <= linear_m:
        return gain_1_s * distance_m
    return sqrt(2.0 * braking_m_s2 * (distance_m - 0.5 * linear_m))
