"""The geofence of a PX4: a cylinder around home, and the uploaded zones, which count wherever there are any."""

from __future__ import annotations

from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.outline import Outline, outline
from vehicle_sim.autopilot.plans.store import Store


class Geofence:
    """One vehicle's borders.

    Attributes:
        breached: it is beyond one of them.
    """

    def __init__(self, store: Store) -> None:
        self._store = store
        self._version = store.version
        self._outline = Outline()
        self.breached = False

    def watch(self, pilot: Autopilot) -> None:
        self.breached = pilot.has_position and self._outside(pilot)

    def _outside(self, pilot: Autopilot) -> bool:
        steering, parameters = pilot.steering, pilot.parameters
        if self._version != self._store.version:
            self._version = self._store.version
            self._outline = outline(self._store.items, steering.ned_from_item)
        radius_m, ceiling_m = parameters["GF_MAX_HOR_DIST"], parameters["GF_MAX_VER_DIST"]
        if 0.0 < radius_m < steering.distance_m(steering.home_ned_m) or 0.0 < ceiling_m < steering.height_m:
            return True
        north_m, east_m, _ = steering.place_ned_m
        return not self._outline.allows(north_m, east_m)
