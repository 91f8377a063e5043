"""What a flight mode is to the rest of the autopilot."""

from __future__ import annotations

from vehicle_sim.autopilot.setpoints import STOP, Setpoint
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import Demand


class Navigator:
    """One stay in one flight mode, from its entry on. This one idles: its motors give no thrust.

    Attributes:
        setpoint: the target that telemetry echoes; STOP where there is none.
        landing: it is on its way down to the ground. lands: once there it disarms soon.
        taking_off: it lifts off, or is about to.
    """

    landing = False
    lands = False
    taking_off = False

    def __init__(self, steering: Steering, now_s: float) -> None:
        self.steering = steering
        self.setpoint: Setpoint = STOP

    def demand(self, now_s: float) -> Demand | None:
        """What to fly over the step that begins at `now_s`; None: no thrust. On the ground it counts if taking off."""
        return None

    def spooled(self, now_s: float) -> bool:
        """Whether a takeoff is past its spool-up: the autopilot counts as flying from here on."""
        return self.taking_off

    def pause(self, paused: bool) -> bool:
        """Stop, or go on; False if this mode has no pause."""
        return False

    def leave(self, now_s: float) -> None:
        """The mode ends."""


class Stop(Navigator):
    """BRAKE: stop as fast as it may, and stay."""

    def demand(self, now_s: float) -> Demand:
        return Demand()
