"""SMART_RTL: back along the breadcrumbs, the way it came, then down from 2 m above where they begin."""

from __future__ import annotations

from comms.frames import Vec3
from vehicle_sim.autopilot.ardupilot.navigation.breadcrumbs import Breadcrumbs
from vehicle_sim.autopilot.ardupilot.navigation.rtl import AT_HOME_M, descend
from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import Demand

ABOVE_HOME_M = 2.0


class Retrace(Navigator):
    """One way back."""

    def __init__(self, steering: Steering, now_s: float, breadcrumbs: Breadcrumbs) -> None:
        super().__init__(steering, now_s)
        self._breadcrumbs = breadcrumbs
        breadcrumbs.clean(accuracy_m=steering.parameters["SRTL_ACCURACY"])
        self._next_ned_m: Vec3 | None = breadcrumbs.pick_up()
        north_m, east_m, down_m = breadcrumbs.home_ned_m
        self._above_home_ned_m = (north_m, east_m, down_m - ABOVE_HOME_M)
        self._descending = False

    @property
    def landing(self) -> bool:  # type: ignore[override]
        return self._descending and self.steering.parameters["RTL_ALT_FINAL"] <= 0.0

    def demand(self, now_s: float) -> Demand:
        steering = self.steering
        if self._next_ned_m is not None and self._reached(self._next_ned_m):
            self._next_ned_m = self._breadcrumbs.pick_up()
        if self._next_ned_m is not None:
            return steering.towards(self._next_ned_m)
        self._descending = self._descending or steering.away_m(self._above_home_ned_m) < AT_HOME_M
        if self._descending:
            return descend(steering, self._above_home_ned_m)
        return steering.towards(self._above_home_ned_m)

    def leave(self, now_s: float) -> None:
        """Give back the place it was on its way to, so that another SMART_RTL still finds the whole way."""
        if self._next_ned_m is not None:
            self._breadcrumbs.put_back(self._next_ned_m)
            self._next_ned_m = None

    def _reached(self, place_ned_m: Vec3) -> bool:
        return self.steering.away_m(place_ned_m) < self.steering.reach_m
