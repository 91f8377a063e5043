"""LAND: straight down, fast high up and slow near the ground."""

from __future__ import annotations

from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.flight import Demand


class Land(Navigator):
    """Down from where it is."""

    landing = True

    def demand(self, now_s: float) -> Demand:
        return Demand(down_m_s=self.steering.sink_m_s())
