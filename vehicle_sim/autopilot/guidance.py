"""From the flight mode to a velocity demand: who flies it now. The modes themselves are in `navigation`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import IntEnum

from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.setpoints import Setpoint
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import Demand, FlightLimits

Begin = Callable[[Steering, float], Navigator]


class Guidance:
    """What one vehicle is doing about its mode. `demand` is asked once a physics step while armed.

    Args:
        begin: for each mode, what begins to fly it. mode: the one it is in at power-on.

    Attributes:
        limits: what the parameters say; a mode begins with them, a change of speed holds until the mode ends.
    """

    def __init__(self, *, steering: Steering, begin: Mapping[IntEnum, Begin], mode: IntEnum) -> None:
        self.steering = steering
        self.limits = steering.airframe.limits
        self.navigator = Navigator(self.steering, 0.0)
        self.mode = mode
        self._begin = begin

    def enter(self, mode: IntEnum, now_s: float) -> None:
        """Begin `mode`: whatever was flown before is forgotten."""
        self.navigator.leave(now_s)
        self.mode = mode
        self._limit()
        self.navigator = self._begin[mode](self.steering, now_s)

    def retune(self) -> None:
        """What the parameters allow acts at once, and ends a change of speed."""
        self.limits = self.steering.parameters.limits(self.limits)
        self._limit()

    def pause(self, paused: bool) -> bool:
        """Stop where it is, or go on, if what is flown can."""
        return self.navigator.pause(paused)

    def demand(self, now_s: float) -> Demand | None:
        """What to fly over the step that begins now; None: motors idle."""
        demand = self.navigator.demand(now_s)
        return demand if self.navigator.taking_off or not self.steering.airframe.on_ground else None

    def spooled(self, now_s: float) -> bool:
        """Whether a takeoff is past its spool-up: the autopilot counts as flying from here on."""
        return self.navigator.spooled(now_s)

    @property
    def setpoint(self) -> Setpoint:
        return self.navigator.setpoint

    @property
    def taking_off(self) -> bool:
        return self.navigator.taking_off

    @property
    def lands(self) -> bool:
        """What is flown ends on the ground, where it disarms soon."""
        return self.navigator.lands

    @property
    def landing(self) -> bool:
        return self.navigator.landing

    def limits_in(self, mode: IntEnum) -> FlightLimits:
        """The limits that `mode` flies by."""
        return self.limits

    def _limit(self) -> None:
        self.steering.airframe.set_limits(self.limits_in(self.mode))
