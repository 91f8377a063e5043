"""TAKEOFF: straight up, to a height above the sea or to MIS_TAKEOFF_ALT above here. HOLD or a mission comes next."""

from __future__ import annotations

from comms.frames import Vec3
from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.navigation.takeoff import Takeoff
from vehicle_sim.autopilot.severity import CRITICAL
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import Demand

HIGHEST_M = 10_000.0


class Lift(Navigator):
    """One takeoff.

    Attributes:
        done: it has arrived.
    """

    def __init__(self, steering: Steering, now_s: float, altitude_m: float | None = None) -> None:
        super().__init__(steering, now_s)
        self._takeoff = Takeoff(steering, down_m=_goal_down_m(steering, altitude_m), now_s=now_s)

    @property
    def done(self) -> bool:
        return self._takeoff.done

    @property
    def goal_ned_m(self) -> Vec3:
        return self._takeoff.goal_ned_m

    @property
    def taking_off(self) -> bool:  # type: ignore[override]
        return not self.done

    def spooled(self, now_s: float) -> bool:
        return self._takeoff.spooled(now_s)

    def demand(self, now_s: float) -> Demand | None:
        return self._takeoff.demand(now_s)


def _goal_down_m(steering: Steering, altitude_m: float | None) -> float:
    """At least MIS_TAKEOFF_ALT above home, and never down from here."""
    least_m = max(0.0, steering.parameters["MIS_TAKEOFF_ALT"])
    here_down_m, lowest_down_m = steering.airframe.down_m, steering.home_ned_m[2] - least_m
    if altitude_m is None:
        return here_down_m - least_m
    down_m = steering.origin.altitude_m - min(altitude_m, HIGHEST_M)
    if down_m > lowest_down_m:
        steering.say(CRITICAL, f"Using minimum takeoff altitude: {least_m:.2f} m")
        down_m = lowest_down_m
    elif down_m > here_down_m:
        steering.say(CRITICAL, "Already higher than takeoff altitude")
    return min(down_m, here_down_m)
