"""How a vehicle moves: a velocity-controlled multirotor, and an ideal one that follows each demand exactly.

The constants fit the recorded ArduCopter 4.5.5 SITL: a step from 0 to 3 m/s gives .41, 1.73 and 2.8 m/s after .5, 1 and
2 s; full acceleration is 2.5 m/s2; level flight at 3 m/s needs .1 rad of tilt, 10.2 m/s all of its 30 degrees; the
vertical acceleration is 1 m/s2.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, cos, hypot, pi, radians, sin, sqrt, tan
from typing import NamedTuple

GRAVITY_M_S2 = 9.80665
VELOCITY_GAIN_1_S = 2.0  # acceleration asked for, per m/s of velocity error
JERK_1_S = 1.6  # jerk over the acceleration limit; in proportion, so that no airframe overshoots its speed
VERTICAL_ACCELERATION_M_S2 = 1.0
VERTICAL_GAIN_1_S = 3.0
VERTICAL_JERK_M_S3 = 5.0
DRAG_1_S = 0.26  # deceleration per m/s of airspeed ...
DRAG_1_M = 0.028  # ... and per (m/s)2
SPEED_RESERVE = 1.02  # top speed at full tilt, over the speed limit
TUMBLE_RAD_S = 4.0  # out of control
TIPPED_RAD = 1.6  # on its side
WIND_TRIM_S = 2.0  # how fast the integrators learn to lean into the wind


@dataclass(frozen=True, slots=True, kw_only=True)
class FlightLimits:
    """What a vehicle can do. `tilt_deg` bounds the lean of roll and pitch together."""

    speed_m_s: float = 10.0
    acceleration_m_s2: float = 2.5
    climb_m_s: float = 2.5
    descent_m_s: float = 1.5
    tilt_deg: float = 30.0

    def __post_init__(self) -> None:
        for name in ("speed_m_s", "acceleration_m_s2", "climb_m_s", "descent_m_s"):
            if not 0.0 < getattr(self, name) <= 100.0:
                raise ValueError(f"limits.{name} is above 0 and at most 100, not {getattr(self, name)}")
        if not 1.0 <= self.tilt_deg <= 80.0:
            raise ValueError(f"limits.tilt_deg is 1 to 80 degrees, not {self.tilt_deg}")


class Demand(NamedTuple):
    """What the airframe is asked to do: a velocity (north, east, down; m/s) and a yaw rate (rad/s).

    `level`: stay level instead, and let the wind have the horizontal velocity.
    """

    north_m_s: float = 0.0
    east_m_s: float = 0.0
    down_m_s: float = 0.0
    yaw_rate_rad_s: float = 0.0
    level: bool = False


class Motion:
    """Where a vehicle is and how it moves: north-east-down meters from where it started, meters a second, radians."""

    def __init__(self, *, yaw_rad: float) -> None:
        self.north_m = self.east_m = self.down_m = 0.0
        self.north_m_s = self.east_m_s = self.down_m_s = 0.0
        self.yaw_rad = wrap_pi(yaw_rad)
        self.yaw_rate_rad_s = 0.0
        self.on_ground = True


class Airframe(Motion):
    """One vehicle's motion over flat ground.

    `step` advances it. Without thrust it sits on the ground or falls. This class answers a demand at once (ideal); the
    multirotor below adds inertia and wind.

    Attributes:
        impact_m_s: vertical speed of the touchdown in the last step, or None.
        lean_ne_m_s2: horizontal part of the thrust, from which attitude follows.
        uncontrolled: a motor is too weak to hold the others' moments: it tumbles and falls, whatever is asked for.
    """

    def __init__(self, *, limits: FlightLimits, yaw_rad: float) -> None:
        super().__init__(yaw_rad=yaw_rad)
        self.limits = limits
        self._lean_max_m_s2 = lean_max_m_s2(limits)
        self._drag_scale = drag_scale(limits)
        self.down_m_s2 = 0.0
        self.lean_ne_m_s2 = (0.0, 0.0)
        self.impact_m_s: float | None = None
        self.uncontrolled = False
        self._tumbled_rad = 0.0

    def set_limits(self, limits: FlightLimits) -> None:
        """Fly by other limits from now on. The airframe, hence its drag, stays the same."""
        self.limits = limits
        self._lean_max_m_s2 = lean_max_m_s2(limits)

    def step(self, dt_s: float, demand: Demand | None, air_ne_m_s: tuple[float, float]) -> None:
        """Advance by `dt_s`. `demand` None: no thrust. `air_ne_m_s`: the wind's velocity, north and east."""
        self.impact_m_s = None
        if self.uncontrolled or self._tumbled_rad:
            demand = self._tumble(dt_s, demand)
        if self.on_ground and (demand is None or demand.down_m_s >= 0.0):
            self._rest()
            return
        self.on_ground = False
        if demand is None:
            self._fall(dt_s)
        else:
            self._follow(dt_s, self._within_limits(demand), air_ne_m_s)
            self.yaw_rate_rad_s = demand.yaw_rate_rad_s
            self.yaw_rad = wrap_pi(self.yaw_rad + demand.yaw_rate_rad_s * dt_s)
        if self.down_m >= 0.0 and self.down_m_s >= 0.0:
            self._touch_down()

    @property
    def attitude_rad(self) -> tuple[float, float]:
        """(roll, pitch) that point the thrust where it goes: right lean is positive roll, forward is negative pitch."""
        if self._tumbled_rad:
            return wrap_pi(self._tumbled_rad), 0.0
        north, east = self.lean_ne_m_s2
        cosine, sine = cos(self.yaw_rad), sin(self.yaw_rad)
        pitch = -atan((north * cosine + east * sine) / GRAVITY_M_S2)
        return atan((east * cosine - north * sine) * cos(pitch) / GRAVITY_M_S2), pitch

    @property
    def tumbling(self) -> bool:
        """Whether it has turned over, in the air or on the ground."""
        return self._tumbled_rad != 0.0

    @property
    def effort(self) -> float:
        """Power over hover power, by thrust to the 1.5 (momentum theory)."""
        north, east = self.lean_ne_m_s2
        up = GRAVITY_M_S2 - self.down_m_s2
        return float((sqrt(north * north + east * east + up * up) / GRAVITY_M_S2) ** 1.5)

    def _within_limits(self, demand: Demand) -> Demand:
        limits = self.limits
        north, east, down, yaw_rate, _ = demand
        speed = hypot(north, east)
        if speed > limits.speed_m_s:
            north *= limits.speed_m_s / speed
            east *= limits.speed_m_s / speed
        return Demand(north, east, max(-limits.climb_m_s, min(limits.descent_m_s, down)), yaw_rate, demand.level)

    def _tumble(self, dt_s: float, demand: Demand | None) -> Demand | None:
        """Turn over: in the air on and on, on the ground onto the side. Whole again, it is upright at once."""
        if not self.uncontrolled:
            self._tumbled_rad = 0.0
            return demand
        if not self.on_ground:
            self._tumbled_rad += TUMBLE_RAD_S * dt_s
        elif demand is not None and demand.down_m_s < 0.0:
            self._tumbled_rad = TIPPED_RAD
        return None

    def _follow(self, dt_s: float, demand: Demand, air_ne_m_s: tuple[float, float]) -> None:
        self.north_m_s, self.east_m_s, self.down_m_s = demand.north_m_s, demand.east_m_s, demand.down_m_s
        if demand.level:
            self.north_m_s, self.east_m_s = air_ne_m_s
        self._move(dt_s)

    def _fall(self, dt_s: float) -> None:
        self.lean_ne_m_s2 = (0.0, 0.0)
        self.yaw_rate_rad_s = 0.0
        keep = 1.0 - DRAG_1_S * dt_s
        self.north_m_s *= keep
        self.east_m_s *= keep
        self.down_m_s = self.down_m_s * keep + GRAVITY_M_S2 * dt_s
        self._move(dt_s)

    def _move(self, dt_s: float) -> None:
        self.north_m += self.north_m_s * dt_s
        self.east_m += self.east_m_s * dt_s
        self.down_m += self.down_m_s * dt_s

    def _touch_down(self) -> None:
        self.impact_m_s = self.down_m_s
        if self._tumbled_rad:
            self._tumbled_rad = max(TIPPED_RAD, self._tumbled_rad % pi)
        self.down_m = 0.0
        self.on_ground = True
        self._rest()

    def _rest(self) -> None:
        self.north_m_s = self.east_m_s = self.down_m_s = self.down_m_s2 = 0.0
        self.yaw_rate_rad_s = 0.0
        self.lean_ne_m_s2 = (0.0, 0.0)


class Multirotor(Airframe):
    """An airframe with inertia: acceleration, jerk and tilt are limited, and gusts push it about."""

    def __init__(
        self, *, limits: FlightLimits, yaw_rad: float, trimmed_ne_m_s: tuple[float, float] = (0.0, 0.0)
    ) -> None:
        super().__init__(limits=limits, yaw_rad=yaw_rad)
        self._north_m_s2 = self._east_m_s2 = 0.0
        self._trim_ne_m_s = trimmed_ne_m_s  # the wind its integrators believe in

    def _follow(self, dt_s: float, demand: Demand, air_ne_m_s: tuple[float, float]) -> None:
        trim_north, trim_east = self._trim_ne_m_s
        miss_north, miss_east = air_ne_m_s[0] - trim_north, air_ne_m_s[1] - trim_east
        wind_north, wind_east = self.north_m_s - trim_north, self.east_m_s - trim_east
        drag_1_s = self._drag_scale * (DRAG_1_S + DRAG_1_M * hypot(wind_north, wind_east))
        self._thrust(dt_s, demand, drag_1_s * wind_north, drag_1_s * wind_east)
        self.north_m_s += (self._north_m_s2 + drag_1_s * miss_north) * dt_s
        self.east_m_s += (self._east_m_s2 + drag_1_s * miss_east) * dt_s
        self.down_m_s += self.down_m_s2 * dt_s
        learnt = dt_s / WIND_TRIM_S
        self._trim_ne_m_s = (trim_north + learnt * miss_north, trim_east + learnt * miss_east)
        self._move(dt_s)

    def _thrust(self, dt_s: float, demand: Demand, drag_north_m_s2: float, drag_east_m_s2: float) -> None:
        """Set the accelerations of this step: towards the demand, slewed by the jerk, then bounded by the tilt."""
        north, east = _shortened(
            VELOCITY_GAIN_1_S * (demand.north_m_s - self.north_m_s),
            VELOCITY_GAIN_1_S * (demand.east_m_s - self.east_m_s),
            self.limits.acceleration_m_s2,
        )
        if demand.level:
            north, east = -drag_north_m_s2, -drag_east_m_s2  # no lean: the drag is left alone
        slew_north, slew_east = _shortened(
            north - self._north_m_s2, east - self._east_m_s2, JERK_1_S * self.limits.acceleration_m_s2 * dt_s
        )
        lean_north, lean_east = _shortened(
            self._north_m_s2 + slew_north + drag_north_m_s2,
            self._east_m_s2 + slew_east + drag_east_m_s2,
            self._lean_max_m_s2,
        )
        self.lean_ne_m_s2 = (lean_north, lean_east)
        self._north_m_s2, self._east_m_s2 = lean_north - drag_north_m_s2, lean_east - drag_east_m_s2

        down = VERTICAL_GAIN_1_S * (demand.down_m_s - self.down_m_s)
        down = max(-VERTICAL_ACCELERATION_M_S2, min(VERTICAL_ACCELERATION_M_S2, down))
        slew = VERTICAL_JERK_M_S3 * dt_s
        self.down_m_s2 += max(-slew, min(slew, down - self.down_m_s2))

    def _rest(self) -> None:
        super()._rest()
        self._north_m_s2 = self._east_m_s2 = 0.0


def lean_max_m_s2(limits: FlightLimits) -> float:
    """The horizontal acceleration that the tilt limit allows."""
    return GRAVITY_M_S2 * tan(radians(limits.tilt_deg))


def drag_scale(limits: FlightLimits) -> float:
    """Drag over the recorded vehicle's: less for an airframe whose tilt could not carry its speed limit otherwise."""
    top_m_s = SPEED_RESERVE * limits.speed_m_s
    return min(1.0, lean_max_m_s2(limits) / (top_m_s * (DRAG_1_S + DRAG_1_M * top_m_s)))


def wrap_pi(angle_rad: float) -> float:
    """The same angle in [-pi, pi)."""
    return (angle_rad + pi) % (2.0 * pi) - pi


def _shortened(x: float, y: float, longest: float) -> tuple[float, float]:
    """The vector, no longer than `longest`."""
    length = hypot(x, y)
    if length <= longest:
        return x, y
    return x * longest / length, y * longest / length
