"""A port for ground stations: one vehicle or a whole swarm on it, each vehicle a MAVLink system of its own.

    with open_ground_link("udpout:127.0.0.1:14550", vehicles, option="--gcs") as link:
        flight.run(pace=pace, observers=[link], stop=stop)

What a ground station sends goes to the vehicle it addresses, or to all. Each vehicle has a channel here, beside the one
its agent holds: with rates of its own, and silent but for heartbeats and news until somebody asks for more. Frames of
one side never pass to the other's.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager

from comms.mavlink import Endpoint
from comms.signing import Signing
from comms.transport import Transport, TransportError, transport_of
from missions.mission import MOST_SYSTEMS
from missions.observation import Observation
from missions.problems import InputError
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.autopilot.channel import Channel

_READER_ID = 255  # it never speaks: any id will do


class GroundLink:
    """Channels of several vehicles on one open transport. An observer: it speaks and listens between ticks.

    With a `key` all of it is signed, and a vehicle hears only what is signed with it. `wall_clock` is what peers'
    silence and back-offs are counted on, however fast the mission goes.

    Attributes:
        url: where ground stations find it.
    """

    def __init__(
        self,
        transport: Transport,
        vehicles: Sequence[SimulatedVehicle],
        *,
        key: bytes | None = None,
        wall_clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._transport = transport
        self._wall_clock = wall_clock
        self._reader = Endpoint(system_id=_READER_ID)
        self._channels = {
            vehicle.autopilot.system_id: vehicle.open_channel(signing=_signing(key)) for vehicle in vehicles
        }
        self.url = transport.url

    def __str__(self) -> str:
        """What went through it, in a line."""
        channels = [channel.endpoint for channel in self._channels.values()]
        sent = sum(end.sent for end in channels)
        dropped = self._reader.dropped + sum(end.dropped for end in channels)
        counts = self._transport.counts
        lost = counts.dropped_in + counts.dropped_out
        refused = sum(end.signing.refused for end in channels if end.signing is not None)
        return (
            f"{self.url}: {self._reader.received} frames in, {sent} out, {self._reader.bad} bad, {dropped} dropped, "
            f"{refused} refused for their signature; {lost} bytes lost in transport"
        )

    def observe(self, observation: Observation) -> None:
        """After a tick of the mission: say what the vehicles said in it, hear what they hear in the next."""
        self.say()
        self.hear()

    def say(self) -> None:
        """Send what the vehicles have said since the last call."""
        wire = b"".join([channel.take() for channel in self._channels.values()])
        if wire:
            self._transport.write(wire)

    def hear(self) -> None:
        """Give what has come to the vehicles it is for; they take it in at their next tick."""
        for chunk in self._transport.read(self._wall_clock()):
            for message in self._reader.receive(chunk):
                frame = bytes(message.get_msgbuf())
                for channel in self._addressed(getattr(message, "target_system", 0)):
                    channel.hear(frame)

    def _addressed(self, system_id: int) -> Sequence[Channel]:
        if system_id == 0:
            return list(self._channels.values())
        channel = self._channels.get(system_id)
        return [] if channel is None else [channel]


def _signing(key: bytes | None) -> Signing | None:
    return None if key is None else Signing(key, unix_time=time.time)


@contextmanager
def open_ground_link(
    url: str, vehicles: Sequence[SimulatedVehicle], *, option: str, key: bytes | None = None
) -> Iterator[GroundLink]:
    """A ground link on the transport that `url` names, which closes with it. `option` is how the user asked for it.

    Raises:
        InputError: it cannot be opened, or vehicles would be the same system there.
    """
    if len({vehicle.autopilot.system_id for vehicle in vehicles}) < len(vehicles):
        raise InputError(f"{option}: got a swarm of {len(vehicles)}; allowed: at most {MOST_SYSTEMS} on one port")
    with ExitStack() as stack:
        try:
            transport = stack.enter_context(transport_of(url))
        except TransportError as error:
            raise InputError(f"{option}: {error}") from error
        yield GroundLink(transport, vehicles, key=key)
