"""Guidance of a PX4: which class flies which mode, and how fast."""

from __future__ import annotations

from dataclasses import replace
from enum import IntEnum

from vehicle_sim.autopilot.guidance import Begin, Guidance
from vehicle_sim.autopilot.mission import Mission
from vehicle_sim.autopilot.navigation.landing import Land
from vehicle_sim.autopilot.navigation.pilot import Leveled, Loiter, Manual
from vehicle_sim.autopilot.px4.modes import MODES, Mode
from vehicle_sim.autopilot.px4.navigation.hold import Hold
from vehicle_sim.autopilot.px4.navigation.mission import FlyMission
from vehicle_sim.autopilot.px4.navigation.offboard import Offboard
from vehicle_sim.autopilot.px4.navigation.rtl import Return
from vehicle_sim.autopilot.px4.navigation.takeoff import Lift
from vehicle_sim.autopilot.px4.setpoints import Trajectory
from vehicle_sim.autopilot.setpoints import Attitude
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import FlightLimits

SLOWEST_M_S, FASTEST_M_S = 0.1, 100.0


class Descent(Land):
    """LAND: it disarms once it is down."""

    lands = True


class Px4Guidance(Guidance):
    """What one PX4 is doing about its mode.

    Attributes:
        takeoff_altitude_m: above the sea, of the last NAV_TAKEOFF; None: it said none.
        asked: the last setpoint, which OFFBOARD begins with.
    """

    def __init__(self, *, steering: Steering, mission: Mission) -> None:
        self.takeoff_altitude_m: float | None = None
        self.asked: Trajectory | Attitude | None = None
        begin: dict[IntEnum, Begin] = {
            Mode.MANUAL: Manual,
            Mode.ALTCTL: Leveled,
            Mode.POSCTL: Loiter,
            Mode.TAKEOFF: lambda steering, now_s: Lift(steering, now_s, self.takeoff_altitude_m),
            Mode.HOLD: Hold,
            Mode.MISSION: lambda steering, now_s: FlyMission(steering, now_s, mission),
            Mode.RTL: Return,
            Mode.LAND: Descent,
            Mode.ACRO: Manual,
            Mode.OFFBOARD: lambda steering, now_s: Offboard(steering, now_s, self.asked),
            Mode.STABILIZED: Manual,
        }
        super().__init__(steering=steering, begin=begin, mode=Mode.HOLD)

    def follow(self, asked: Trajectory | Attitude) -> None:
        """The newest setpoint: OFFBOARD flies it at once, any other mode does not."""
        self.asked = asked
        if isinstance(self.navigator, Offboard):
            self.navigator.follow(asked)

    def limits_in(self, mode: IntEnum) -> FlightLimits:
        """What flies by itself cruises; a takeoff climbs slower still."""
        limits, parameters = self.limits, self.steering.parameters
        if not MODES[Mode(mode)].auto:
            return limits
        climb = "MPC_TKO_SPEED" if mode is Mode.TAKEOFF else "MPC_Z_V_AUTO_UP"
        return replace(
            limits,
            speed_m_s=_slower(parameters["MPC_XY_CRUISE"], limits.speed_m_s),
            climb_m_s=_slower(parameters[climb], limits.climb_m_s),
            descent_m_s=_slower(parameters["MPC_Z_V_AUTO_DN"], limits.descent_m_s),
        )


def _slower(wanted_m_s: float, limit_m_s: float) -> float:
    return max(SLOWEST_M_S, min(FASTEST_M_S, wanted_m_s, limit_m_s))
