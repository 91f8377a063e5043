"""LAND: straight down, fast high up and slow near the ground."""

from __future__ import annotations

from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.steering import TIME_SLACK_S, Steering
from vehicle_sim.flight import Demand

PAUSE_S = 4.0  # before a failsafe's landing sinks, so that a person can take over (LAND_WITH_DELAY_MS)


class Land(Navigator):
    """Down from where it is."""

    landing = True

    def __init__(self, steering: Steering, now_s: float) -> None:
        super().__init__(steering, now_s)
        self._began_s = now_s
        self._pause_s = 0.0

    def linger(self) -> None:
        """Begin with some seconds at the height it has."""
        self._pause_s = PAUSE_S

    def demand(self, now_s: float) -> Demand:
        if now_s - self._began_s < self._pause_s - TIME_SLACK_S:
            return Demand()
        return Demand(down_m_s=self.steering.sink_m_s())
