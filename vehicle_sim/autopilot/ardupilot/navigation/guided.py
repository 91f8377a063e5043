"""GUIDED: what a ground station or a companion asks for, setpoint by setpoint."""

from __future__ import annotations

from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.setpoints import STOP, Attitude, Setpoint
from vehicle_sim.autopilot.steering import TIME_SLACK_S, Steering
from vehicle_sim.flight import Demand

LEVEL = Attitude(0.0, 0.0, 0.0, 0.0)


class Guided(Navigator):
    """Flies the last setpoint: a position for good, a velocity or an attitude for GUID_TIMEOUT, then it stops."""

    def __init__(self, steering: Steering, now_s: float) -> None:
        super().__init__(steering, now_s)
        self._heard_at_s = now_s
        self._attitude: Attitude | None = None
        self.paused = False

    def follow(self, setpoint: Setpoint, now_s: float) -> None:
        self.setpoint = setpoint
        self._attitude = None
        self._heard_at_s = now_s

    def lean(self, attitude: Attitude, now_s: float) -> None:
        self.setpoint = STOP
        self._attitude = attitude
        self._heard_at_s = now_s

    def turn(self, yaw_rad: float) -> None:
        """Go on with what it does, nose to `yaw_rad`."""
        if self.setpoint == STOP:
            self.setpoint = Setpoint(position_ned_m=self.steering.stopping_ned_m())
        self.setpoint = self.setpoint._replace(yaw_rad=yaw_rad, yaw_rate_rad_s=None)

    def pause(self, paused: bool) -> bool:
        """Stop where it is, or go on with the setpoint it has."""
        self.paused = paused
        return True

    def demand(self, now_s: float) -> Demand:
        if self.paused:
            return Demand()
        steering = self.steering
        fresh = now_s - self._heard_at_s < steering.parameters["GUID_TIMEOUT"] - TIME_SLACK_S
        if self._attitude is not None:
            return self._leaned(self._attitude if fresh else LEVEL)
        position, velocity, yaw_rad, yaw_rate = self.setpoint
        if position is not None:
            return steering.towards(position, yaw_rate_rad_s=steering.turn_rad_s(yaw_rad, yaw_rate))
        if velocity is None or not fresh:
            return Demand()
        return Demand(*velocity, steering.turn_rad_s(yaw_rad, yaw_rate))

    def _leaned(self, attitude: Attitude) -> Demand:
        steering = self.steering
        north_m_s, east_m_s = steering.leaned_m_s(attitude.roll_rad, attitude.pitch_rad)
        turn_rad_s = 0.0 if attitude is LEVEL else steering.turn_rad_s(attitude.yaw_rad)
        return Demand(north_m_s, east_m_s, steering.climb_share_m_s(attitude.climb), turn_rad_s)
