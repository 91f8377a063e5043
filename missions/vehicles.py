"""What carries an agent, as a flight sees it: simulated in process, or a real one behind a link."""

from __future__ import annotations

from typing import Protocol

from comms.frames import Vec3, swap_enu_ned
from comms.transport import Transport
from swarm_agent.autopilot import Pilot
from vehicle_sim.vehicle import VehicleTruth

NOWHERE: Vec3 = (0.0, 0.0, 0.0)


class Vehicle(Protocol):
    """One vehicle on a MAVLink link, and where it is."""

    def tick(self, now_s: float, wire_in: bytes) -> bytes:
        """Take what its agent sends, live until `now_s` on the mission clock, and return what it says."""

    @property
    def truth(self) -> VehicleTruth:
        """Where it is, north, east and down of its pad."""


class LinkedVehicle:
    """A vehicle that is not ours to simulate. It is where it says it is: nothing else here knows.

    Args:
        transport: open, with the vehicle on the other side. pilot: its agent's, which listens to it.
        pad_m: the point that its truth counts from, ENU meters.
    """

    def __init__(self, transport: Transport, *, pilot: Pilot, pad_m: Vec3) -> None:
        self.transport = transport
        self.pilot = pilot
        self._pad_m = pad_m

    def tick(self, now_s: float, wire_in: bytes) -> bytes:
        """Send, and take what has come; neither waits."""
        self.transport.write(wire_in)
        return b"".join(self.transport.read(now_s))

    @property
    def truth(self) -> VehicleTruth:
        """As telemetry has it; until it has told anything it stands on its pad."""
        state, pad = self.pilot.state, self._pad_m
        here = state.position_m or pad
        return VehicleTruth(
            position_ned_m=swap_enu_ned((here[0] - pad[0], here[1] - pad[1], here[2] - pad[2])),
            velocity_ned_m_s=swap_enu_ned(state.velocity_m_s or NOWHERE),
            roll_rad=0.0,
            pitch_rad=0.0,
            yaw_rad=state.heading_rad,
            on_ground=state.landed is not False,
            armed=state.armed,
        )
