"""A ground station with one simulated PX4 on its link."""

from __future__ import annotations

import struct
from math import nan
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import HOME, SYSTEM, GroundStation, velocity
from vehicle_sim.autopilot.px4.commander import Commander
from vehicle_sim.autopilot.px4.modes import Mode
from vehicle_sim.vehicle import VehicleConfig

ACCEPTED, REJECTED, DENIED, UNSUPPORTED, FAILED = range(5)
BEAT = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
INTEGER, REAL = 6, 9


class Px4Station(GroundStation):
    """As a `GroundStation`, in PX4's words."""

    def __init__(self, config: VehicleConfig | None = None, **vehicle: Any) -> None:
        super().__init__(config or VehicleConfig(flavor="px4"), **vehicle)

    @property
    def pilot(self) -> Commander:
        assert isinstance(self.vehicle.autopilot, Commander)
        return self.vehicle.autopilot

    @property
    def mode(self) -> Mode:
        return self.pilot.mode

    def choose(self, mode: Mode) -> int:
        return self.order(176, 1, mode >> 16 & 0xFF, mode >> 24)

    def texts(self) -> list[str]:
        """Whole ones: the pieces of a long one are put together."""
        whole: list[str] = []
        for _, message in self.all("STATUSTEXT"):
            if message.id and message.chunk_seq:
                whole[-1] += message.text
            else:
                whole.append(message.text)
        return whole

    def set(self, name: str, value: float, kind: int = REAL) -> list[Any]:
        """PARAM_SET, an integer as its bytes."""
        wired = value if kind == REAL else struct.unpack("<f", struct.pack("<i", int(value)))[0]
        return self.tick(dialect.MAVLink_param_set_message(SYSTEM, 1, name.encode(), wired, kind))

    def stream_velocity(self, *ned: float, seconds: float) -> None:
        for _ in range(round(seconds * 10.0)):
            self.tick(velocity(*ned))


def ready(config: VehicleConfig | None = None, **vehicle: Any) -> Px4Station:
    """Booted, in HOLD, not armed."""
    station = Px4Station(config, **vehicle)
    station.tick(seconds=3.0)
    return station


def flying(config: VehicleConfig | None = None, *, height_m: float = 10.0, **vehicle: Any) -> Px4Station:
    """In HOLD at `height_m` above home."""
    station = ready(config, **vehicle)
    assert station.order(400, 1) == ACCEPTED
    assert station.order(22, 0, 0, 0, nan, nan, nan, HOME.altitude_m + height_m) == ACCEPTED
    station.tick(seconds=4.0 + height_m)
    assert station.mode is Mode.HOLD
    return station


def in_offboard(north: float = 0.0) -> Px4Station:
    """Flying by velocity setpoints."""
    station = flying()
    station.stream_velocity(north, seconds=0.3)
    assert station.choose(Mode.OFFBOARD) == ACCEPTED
    return station
