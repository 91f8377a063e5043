"""OFFBOARD: what a companion asks for, axis by axis. It lifts off by itself when that leads up."""

from __future__ import annotations

from comms.frames import Vec3
from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.px4.setpoints import Axes, Trajectory
from vehicle_sim.autopilot.setpoints import Attitude, Setpoint
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import VELOCITY_GAIN_1_S, Demand

UP_M_S = 0.1  # faster than this it lifts off


class Offboard(Navigator):
    """One stay in OFFBOARD: flies the last setpoint; `failsafes` ends it when setpoints stop."""

    def __init__(self, steering: Steering, now_s: float, asked: Trajectory | Attitude | None) -> None:
        super().__init__(steering, now_s)
        self._asked = asked
        self._echo()

    def follow(self, asked: Trajectory | Attitude) -> None:
        self._asked = asked
        self._echo()

    @property
    def taking_off(self) -> bool:  # type: ignore[override]
        return self.steering.airframe.on_ground and self._wanted().down_m_s < -UP_M_S

    def demand(self, now_s: float) -> Demand:
        return self._wanted()

    def _wanted(self) -> Demand:
        if self._asked is None:
            return Demand()
        return self._leaned(self._asked) if isinstance(self._asked, Attitude) else self._along(self._asked)

    def _along(self, asked: Trajectory) -> Demand:
        north_m_s, east_m_s = self._over_ground(asked)
        down_m, down_m_s = asked.position_ned_m[2], asked.velocity_ned_m_s[2]
        if down_m is not None:
            down_m_s = self.steering.climb_m_s(down_m) + (down_m_s or 0.0)
        turn_rad_s = self.steering.turn_rad_s(asked.yaw_rad, asked.yaw_rate_rad_s)
        return Demand(north_m_s, east_m_s, down_m_s or 0.0, turn_rad_s)

    def _over_ground(self, asked: Trajectory) -> tuple[float, float]:
        """North and east come together: half a plane is none, and stops it."""
        steering = self.steering
        place, velocity, push = (_plane(axes) for axes in asked[:3])
        if place is not None:
            demand = steering.towards((*place, 0.0))
            forward = velocity or (0.0, 0.0)
            return demand.north_m_s + forward[0], demand.east_m_s + forward[1]
        if velocity is not None:
            return velocity
        if push is not None:
            frame = steering.airframe
            return frame.north_m_s + push[0] / VELOCITY_GAIN_1_S, frame.east_m_s + push[1] / VELOCITY_GAIN_1_S
        return 0.0, 0.0

    def _leaned(self, attitude: Attitude) -> Demand:
        steering = self.steering
        north_m_s, east_m_s = steering.leaned_m_s(attitude.roll_rad, attitude.pitch_rad)
        climb_m_s = steering.climb_share_m_s(attitude.climb)
        return Demand(north_m_s, east_m_s, climb_m_s, steering.turn_rad_s(attitude.yaw_rad))

    def _echo(self) -> None:
        """What telemetry says of it: whole vectors alone."""
        if isinstance(self._asked, Trajectory):
            position, velocity = _whole(self._asked.position_ned_m), _whole(self._asked.velocity_ned_m_s)
            self.setpoint = Setpoint(position, velocity, self._asked.yaw_rad, self._asked.yaw_rate_rad_s)
        else:
            self.setpoint = Setpoint()


def _plane(axes: Axes) -> tuple[float, float] | None:
    north, east, _ = axes
    return None if north is None or east is None else (north, east)


def _whole(axes: Axes) -> Vec3 | None:
    north, east, down = axes
    return None if north is None or east is None or down is None else (north, east, down)
