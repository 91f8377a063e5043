"""HOLD: stop and stay, or go where a ground station says (DO_REPOSITION) and stay there."""

from __future__ import annotations

from comms.frames import Vec3
from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.setpoints import Setpoint
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import Demand


class Hold(Navigator):
    """One stay in HOLD."""

    def __init__(self, steering: Steering, now_s: float) -> None:
        super().__init__(steering, now_s)
        self.go(steering.stopping_ned_m())

    def go(self, goal_ned_m: Vec3, *, yaw_rad: float | None = None) -> None:
        """Stay there from now on."""
        self.setpoint = Setpoint(position_ned_m=goal_ned_m, yaw_rad=yaw_rad)

    def demand(self, now_s: float) -> Demand:
        goal_ned_m, _, yaw_rad, _ = self.setpoint
        assert goal_ned_m is not None, "it always has a place to stay"
        return self.steering.towards(goal_ned_m, yaw_rate_rad_s=self.steering.turn_rad_s(yaw_rad))
