"""Guidance of an ArduCopter: takeoffs from several modes, what GUIDED listens to, and the trail of SMART_RTL."""

from __future__ import annotations

from dataclasses import replace
from enum import IntEnum

from vehicle_sim.autopilot.ardupilot.modes import MODES, Mode
from vehicle_sim.autopilot.ardupilot.navigation.breadcrumbs import Breadcrumbs
from vehicle_sim.autopilot.ardupilot.navigation.guided import Guided
from vehicle_sim.autopilot.ardupilot.navigation.mission import COPTER_LEGS
from vehicle_sim.autopilot.ardupilot.navigation.rtl import ReturnHome
from vehicle_sim.autopilot.ardupilot.navigation.smart_rtl import Retrace
from vehicle_sim.autopilot.guidance import Begin, Guidance
from vehicle_sim.autopilot.mission import Mission
from vehicle_sim.autopilot.navigation.auto import Auto
from vehicle_sim.autopilot.navigation.landing import Land
from vehicle_sim.autopilot.navigation.navigator import Stop
from vehicle_sim.autopilot.navigation.pilot import Leveled, Loiter, Manual
from vehicle_sim.autopilot.navigation.takeoff import Takeoff
from vehicle_sim.autopilot.setpoints import Attitude, Setpoint
from vehicle_sim.autopilot.severity import CRITICAL, WARNING
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import Demand, FlightLimits


class CopterGuidance(Guidance):
    """What one ArduCopter is doing about its mode.

    Attributes:
        breadcrumbs: the way back of SMART_RTL.
    """

    mode: Mode

    def __init__(self, *, steering: Steering, mission: Mission) -> None:
        self.breadcrumbs = Breadcrumbs()
        self._mission = mission
        self._takeoff: Takeoff | None = None
        begin: dict[IntEnum, Begin] = {
            Mode.STABILIZE: Manual,
            Mode.ALT_HOLD: Leveled,
            Mode.AUTO: lambda steering, now_s: Auto(steering, now_s, mission, legs=COPTER_LEGS),
            Mode.GUIDED: Guided,
            Mode.LOITER: Loiter,
            Mode.RTL: ReturnHome,
            Mode.LAND: Land,
            Mode.POSHOLD: Loiter,
            Mode.BRAKE: Stop,
            Mode.SMART_RTL: lambda steering, now_s: Retrace(steering, now_s, self.breadcrumbs),
        }
        super().__init__(steering=steering, begin=begin, mode=Mode.STABILIZE)

    def can_enter(self, mode: Mode, *, armed: bool, flying: bool) -> bool:
        """Whether the mode has what it needs besides a position: SMART_RTL a trail, AUTO a mission."""
        if mode is Mode.SMART_RTL:
            return self.breadcrumbs.active
        if mode is not Mode.AUTO or not armed:
            return True
        if len(self._mission.items) < 2:
            return False
        restarts = self.steering.parameters["MIS_RESTART"] == 1.0
        if flying or self._mission.begins_with_takeoff(restarts=restarts):
            return True
        self.steering.say(CRITICAL, "Auto: Missing Takeoff Cmd")
        return False

    def enter(self, mode: IntEnum, now_s: float) -> None:
        """Begin `mode`, which `can_enter`: whatever was flown before is forgotten."""
        self._takeoff = None
        super().enter(mode, now_s)

    def rest(self, now_s: float) -> None:
        """Disarmed: what was flown is forgotten. A mission begins again, unless it was complete: as ArduCopter does."""
        if not (isinstance(self.navigator, Auto) and self._mission.complete):
            self.enter(self.mode, now_s)

    def take_off(self, altitude_m: float, now_s: float) -> None:
        """Climb to `altitude_m` above home, straight up."""
        down_m = self.steering.home_ned_m[2] - altitude_m
        self.steering.throttle_up = True
        self._takeoff = Takeoff(self.steering, down_m=down_m, now_s=now_s)

    def end_takeoff(self) -> None:
        """No further up: something else is flown from here on."""
        self._takeoff = None

    def follow(self, setpoint: Setpoint, now_s: float) -> None:
        """A GUIDED setpoint. On the ground and during a takeoff it is ignored, as ArduCopter does."""
        if (guided := self._listening) is not None:
            guided.follow(setpoint, now_s)

    def lean(self, attitude: Attitude, now_s: float) -> None:
        """A GUIDED attitude, as `follow`."""
        if (guided := self._listening) is not None:
            guided.lean(attitude, now_s)

    def turn(self, yaw_rad: float) -> None:
        """Point the nose there, in GUIDED and in AUTO; a pilot turns other modes."""
        if isinstance(self.navigator, Auto):
            self.navigator.turn(yaw_rad)
        elif (guided := self._listening) is not None:
            guided.turn(yaw_rad)

    def demand(self, now_s: float) -> Demand | None:
        return super().demand(now_s) if self._takeoff is None else self._take_off(self._takeoff, now_s)

    def spooled(self, now_s: float) -> bool:
        return (self._takeoff or self.navigator).spooled(now_s)

    def drop_crumb(self) -> None:
        """Leave a mark on the way out, for SMART_RTL."""
        if self.mode is Mode.SMART_RTL:
            return
        parameters = self.steering.parameters
        apart_m, most = parameters["SRTL_ACCURACY"], int(parameters["SRTL_POINTS"])
        if not self.breadcrumbs.drop(self.steering.place_ned_m, apart_m=apart_m, most=most):
            self.steering.say(WARNING, "SmartRTL deactivated: buffer full")

    @property
    def _listening(self) -> Guided | None:
        """GUIDED, in the air and past its takeoff."""
        guided = self.navigator
        if not isinstance(guided, Guided) or self.taking_off or self.steering.airframe.on_ground:
            return None
        return guided

    @property
    def taking_off(self) -> bool:
        return self._takeoff is not None or self.navigator.taking_off

    @property
    def lands(self) -> bool:
        return MODES[self.mode].lands or self.navigator.lands

    def limits_in(self, mode: IntEnum) -> FlightLimits:
        """A pilot climbs and sinks at speeds of his own."""
        if not MODES[Mode(mode)].sticks:
            return self.limits
        parameters = self.steering.parameters
        up_m_s = max(0.1, parameters["PILOT_SPEED_UP"] / 100.0)
        down_m_s = parameters["PILOT_SPEED_DN"] / 100.0 or up_m_s
        return replace(self.limits, climb_m_s=min(100.0, up_m_s), descent_m_s=max(0.1, min(100.0, down_m_s)))

    def _take_off(self, takeoff: Takeoff, now_s: float) -> Demand | None:
        demand = takeoff.demand(now_s)
        if takeoff.done:
            self._takeoff = None
            if isinstance(self.navigator, Guided):
                self.navigator.follow(Setpoint(position_ned_m=takeoff.goal_ned_m), now_s)
        return demand
