"""The ways of a mission as an ArduCopter flies them."""

from __future__ import annotations

from math import inf

from vehicle_sim.autopilot.ardupilot.navigation.rtl import ReturnHome
from vehicle_sim.autopilot.mission import Mission
from vehicle_sim.autopilot.navigation.legs import LANDED_AFTER_S, LEGS, BeginLeg, Leg
from vehicle_sim.autopilot.plans import commands
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.steering import TIME_SLACK_S, Steering
from vehicle_sim.flight import Demand


class ReturnLeg(Leg):
    """RTL, as a part of the mission: done on the ground."""

    def __init__(self, steering: Steering, now_s: float, item: Item, mission: Mission) -> None:
        super().__init__(steering, now_s, item, mission)
        self._return = ReturnHome(steering, now_s)
        self._down_at_s = inf

    def done(self, now_s: float) -> bool:
        if self.landing and self.steering.airframe.on_ground:
            self._down_at_s = min(self._down_at_s, now_s)
        return now_s - self._down_at_s >= LANDED_AFTER_S - TIME_SLACK_S

    @property
    def landing(self) -> bool:  # type: ignore[override]
        return self._return.landing

    def demand(self, now_s: float) -> Demand:
        return self._return.demand(now_s)


COPTER_LEGS: dict[int, BeginLeg] = LEGS | {commands.RETURN: ReturnLeg}
