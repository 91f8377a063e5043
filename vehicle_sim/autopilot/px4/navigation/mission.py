"""MISSION: the shared course, with a takeoff of its own where a mission has none, and PX4's return."""

from __future__ import annotations

from math import inf

from vehicle_sim.autopilot.mission import Mission
from vehicle_sim.autopilot.navigation.auto import Auto
from vehicle_sim.autopilot.navigation.legs import LANDED_AFTER_S, LEGS, Leg, TakeoffLeg
from vehicle_sim.autopilot.plans import commands
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.px4.navigation.rtl import Return
from vehicle_sim.autopilot.px4.navigation.takeoff import Lift
from vehicle_sim.autopilot.steering import TIME_SLACK_S, Steering
from vehicle_sim.flight import Demand


class ReturnLeg(Leg):
    """RTL as a part of the mission: done on the ground."""

    lands = True

    def __init__(self, steering: Steering, now_s: float, item: Item, mission: Mission) -> None:
        super().__init__(steering, now_s, item, mission)
        self._return = Return(steering, now_s)
        self._down_at_s = inf

    @property
    def landing(self) -> bool:  # type: ignore[override]
        return self._return.landing

    def done(self, now_s: float) -> bool:
        if self.landing and self.steering.airframe.on_ground:
            self._down_at_s = min(self._down_at_s, now_s)
        return now_s - self._down_at_s >= LANDED_AFTER_S - TIME_SLACK_S

    def demand(self, now_s: float) -> Demand:
        return self._return.demand(now_s)


PX4_LEGS = LEGS | {commands.RETURN: ReturnLeg}


class FlyMission(Auto):
    """One stay in MISSION. On the ground it lifts off first, whatever the first way is."""

    def __init__(self, steering: Steering, now_s: float, mission: Mission) -> None:
        super().__init__(steering, now_s, mission, legs=PX4_LEGS)
        self._lift: Lift | None = None

    @property
    def taking_off(self) -> bool:  # type: ignore[override]
        return self._lift is not None or super().taking_off

    def spooled(self, now_s: float) -> bool:
        return super().spooled(now_s) if self._lift is None else self._lift.spooled(now_s)

    def demand(self, now_s: float) -> Demand | None:
        if self._lift is not None:
            demand = self._lift.demand(now_s)
            self._lift = None if self._lift.done else self._lift
            return demand
        demand = super().demand(now_s)
        if self.steering.airframe.on_ground and self._has_far_to_go:
            self._lift = Lift(self.steering, now_s)
        return demand

    @property
    def _has_far_to_go(self) -> bool:
        """Whether the way that is current needs a vehicle in the air, and does not lift it itself."""
        leg = self.leg
        return leg is not None and not isinstance(leg, TakeoffLeg) and not leg.landing and not leg.lands
