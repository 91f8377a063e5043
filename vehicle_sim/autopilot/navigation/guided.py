"""GUIDED: what a ground station or a companion asks for, setpoint by setpoint."""

from __future__ import annotations

from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.setpoints import Setpoint
from vehicle_sim.autopilot.steering import TIME_SLACK_S, Steering
from vehicle_sim.flight import Demand


class Guided(Navigator):
    """Flies the last setpoint: a position for good, a velocity for GUID_TIMEOUT, then it stops where it is."""

    def __init__(self, steering: Steering, now_s: float) -> None:
        super().__init__(steering, now_s)
        self._heard_at_s = now_s

    def follow(self, setpoint: Setpoint, now_s: float) -> None:
        self.setpoint = setpoint
        self._heard_at_s = now_s

    def demand(self, now_s: float) -> Demand:
        steering = self.steering
        position, velocity, yaw_rad, yaw_rate = self.setpoint
        if position is not None:
            return steering.towards(position, yaw_rate_rad_s=steering.turn_rad_s(yaw_rad, yaw_rate))
        if velocity is None or now_s - self._heard_at_s >= steering.parameters["GUID_TIMEOUT"] - TIME_SLACK_S:
            return Demand()
        return Demand(*velocity, steering.turn_rad_s(yaw_rad, yaw_rate))
