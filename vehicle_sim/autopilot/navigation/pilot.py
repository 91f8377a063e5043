"""The modes of a pilot with sticks: STABILIZE, ALT_HOLD, LOITER and POSHOLD.

Without a pilot the throttle is at its bottom: STABILIZE falls, the others sink at PILOT_SPEED_DN (recorded in LOITER),
so none of them is a "hold" for a ground station.
"""

from __future__ import annotations

from math import hypot, radians, tan

from comms.frames import Vec3
from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.steering import YAW_RATE_MAX_RAD_S, Steering
from vehicle_sim.flight import GRAVITY_M_S2, Demand

STILL_M_S = 0.5  # slower than this, a loitering vehicle holds its place


class Leveled(Navigator):
    """ALT_HOLD: the throttle climbs, roll and pitch lean, and without them it coasts until the air has slowed it."""

    @property
    def taking_off(self) -> bool:  # type: ignore[override]
        return self.steering.airframe.on_ground and self.steering.sticks.climb() > 0.0

    def demand(self, now_s: float) -> Demand | None:
        north_m_s, east_m_s = self._over_ground()
        sticks = self.steering.sticks
        return Demand(
            north_m_s,
            east_m_s,
            self.steering.climb_share_m_s(self.steering.sticks.climb()),
            sticks.yaw * YAW_RATE_MAX_RAD_S,
        )

    def _over_ground(self) -> tuple[float, float]:
        """As its lean pushes it."""
        sticks = self.steering.sticks
        lean_m_s2 = GRAVITY_M_S2 * tan(radians(self.steering.airframe.limits.tilt_deg))
        return self.steering.pushed_m_s(sticks.pitch * lean_m_s2, sticks.roll * lean_m_s2)


class Manual(Leveled):
    """STABILIZE: as ALT_HOLD, but with the throttle at its bottom there is no thrust.

    A throttle in between is a climb rate here and a thrust in a real one.
    """

    def demand(self, now_s: float) -> Demand | None:
        return None if self.steering.sticks.throttle == 0.0 else super().demand(now_s)


class Loiter(Leveled):
    """LOITER and POSHOLD: roll and pitch are velocities, and without them it holds its place."""

    def __init__(self, steering: Steering, now_s: float) -> None:
        super().__init__(steering, now_s)
        self._held_ned_m: Vec3 | None = None

    def _over_ground(self) -> tuple[float, float]:
        frame, sticks = self.steering.airframe, self.steering.sticks
        if not sticks.centered:
            self._held_ned_m = None
            speed_m_s = self.steering.parameters["LOIT_SPEED"] / 100.0
            return self.steering.turned(sticks.pitch * speed_m_s, sticks.roll * speed_m_s)
        if self._held_ned_m is None:
            if hypot(frame.north_m_s, frame.east_m_s) > STILL_M_S:
                return 0.0, 0.0
            self._held_ned_m = self.steering.place_ned_m
        back = self.steering.towards(self._held_ned_m)
        return back.north_m_s, back.east_m_s
