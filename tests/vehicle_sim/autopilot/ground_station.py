"""A ground station with one simulated vehicle on its link: for tests that read like a flight log."""

from __future__ import annotations

from math import nan
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint
from comms.mavlink import Endpoint
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.vehicle import VehicleConfig

HOME = GeoPoint(47.397742, 8.545594, 488.1)
TICK_S = 0.1
SYSTEM = 3
VELOCITY, VELOCITY_YAW, VELOCITY_YAW_RATE, POSITION = 0xDC7, 0x9C7, 0x5C7, 0xDF8
STABILIZE, ALT_HOLD, AUTO, GUIDED, LOITER = 0, 2, 3, 4, 5
RTL, LAND, POSHOLD, BRAKE, SMART_RTL = 6, 9, 16, 17, 21


class GroundStation:
    """Sends at once with `tick`; keeps everything it hears in `log` as (seconds, message)."""

    def __init__(self, config: VehicleConfig | None = None, **vehicle: Any) -> None:
        self.vehicle = SimulatedVehicle(config=config or VehicleConfig(), system_id=SYSTEM, home=HOME, **vehicle)
        self.out = Endpoint(system_id=255, component_id=190)
        self._in = Endpoint(system_id=255, component_id=190)
        self.ticks = 0
        self.log: list[tuple[float, Any]] = []

    @property
    def now_s(self) -> float:
        return self.ticks * TICK_S

    def tick(self, *messages: Any, seconds: float = TICK_S) -> list[Any]:
        """Send, let time pass, and return what came back meanwhile."""
        for message in messages:
            self.out.send(message)
        heard: list[Any] = []
        for _ in range(round(seconds / TICK_S)):
            self.ticks += 1
            news = self._in.receive(self.vehicle.tick(self.now_s, self.out.take()))
            self.log += [(self.now_s, message) for message in news]
            heard += news
        return heard

    def order(self, command: int, *params: float) -> int:
        """Send a command; its result."""
        heard = self.tick(order(command, *params))
        return next(m.result for m in heard if m.get_type() == "COMMAND_ACK" and m.command == command)

    def stream(self, *message_ids: int) -> None:
        for message_id in message_ids:
            assert self.order(511, message_id, 100_000) == 0

    def texts(self) -> list[str]:
        return [message.text for _, message in self.log if message.get_type() == "STATUSTEXT"]

    def all(self, kind: str) -> list[tuple[float, Any]]:
        return [(at_s, message) for at_s, message in self.log if message.get_type() == kind]

    def last(self, kind: str) -> Any:
        return self.all(kind)[-1][1]


def order(command: int, *params: float, system: int = SYSTEM, component: int = 1) -> Any:
    padded = [*params, *[0.0] * (7 - len(params))]
    return dialect.MAVLink_command_long_message(system, component, command, 0, *padded)


def velocity(
    north: float, east: float = 0.0, down: float = 0.0, *, mask: int = VELOCITY, frame: int = 1, yaw: float = 0.0,
    yaw_rate: float = 0.0, system: int = SYSTEM,
) -> Any:  # fmt: skip
    """A velocity setpoint whose ignored fields are NaN, as they may be."""
    return dialect.MAVLink_set_position_target_local_ned_message(
        0, system, 1, frame, mask, nan, nan, nan, north, east, down, nan, nan, nan, yaw, yaw_rate
    )


def position(north: float, east: float, down: float, *, mask: int = POSITION, frame: int = 1) -> Any:
    return dialect.MAVLink_set_position_target_local_ned_message(
        0, SYSTEM, 1, frame, mask, north, east, down, 0, 0, 0, 0, 0, 0, 0, 0
    )


def ready(config: VehicleConfig | None = None, **vehicle: Any) -> GroundStation:
    """Booted, in GUIDED, not armed."""
    station = GroundStation(config, **vehicle)
    station.tick(seconds=3.0)
    assert station.order(176, 1, GUIDED) == 0
    return station


def flying(config: VehicleConfig | None = None, *, altitude_m: float = 10.0, **vehicle: Any) -> GroundStation:
    """Hovering at `altitude_m` above home."""
    station = ready(config, **vehicle)
    assert station.order(400, 1) == 0
    assert station.order(22, 0, 0, 0, nan, 0, 0, altitude_m) == 0
    station.tick(seconds=12.0)
    return station
