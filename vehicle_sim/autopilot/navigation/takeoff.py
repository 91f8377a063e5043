"""A takeoff: spool up, then straight up to a height. GUIDED, AUTO and the pilot's modes begin with it."""

from __future__ import annotations

from vehicle_sim.autopilot.steering import TIME_SLACK_S, Steering
from vehicle_sim.flight import Demand

SPOOL_UP_S = 1.0  # from the takeoff command to the first lift (recorded)
TAKEN_OFF_M = 0.1  # below the takeoff altitude: done


class Takeoff:
    """One takeoff, from the command until `done`."""

    def __init__(self, steering: Steering, *, down_m: float, now_s: float) -> None:
        self._steering = steering
        self._spooled_at_s = now_s + SPOOL_UP_S
        north_m, east_m, _ = steering.place_ned_m
        self.goal_ned_m = (north_m, east_m, down_m)
        self.done = False

    def spooled(self, now_s: float) -> bool:
        """Whether the spool-up is over: the autopilot counts as flying from here on."""
        return now_s >= self._spooled_at_s - TIME_SLACK_S

    def demand(self, now_s: float) -> Demand | None:
        if not self.spooled(now_s):
            return None
        if self._steering.airframe.down_m - self.goal_ned_m[2] < TAKEN_OFF_M:
            self.done = True
        return self._steering.towards(self.goal_ned_m)
