"""One link of a vehicle: an autopilot answers on the link it was asked on, and every link has rates of its own."""

from __future__ import annotations

from typing import Any

from comms.mavlink import BYTES_IN, Endpoint
from comms.signing import Signing
from vehicle_sim.autopilot.streams import Streams


class Channel:
    """What a vehicle knows of one of its links.

        channel.hear(wire_in)        # before the vehicle's tick
        wire_out = channel.take()    # after it

    Attributes:
        endpoint: with sequence numbers of its own. streams: what the other side asked for.
    """

    def __init__(self, *, system_id: int, streams: Streams, signing: Signing | None = None) -> None:
        self.endpoint = Endpoint(system_id=system_id, signing=signing)
        self.streams = streams
        self._heard = b""

    def hear(self, wire: bytes) -> None:
        """Bytes that the vehicle takes in at its next tick."""
        heard = self._heard + wire if self._heard else wire
        if len(heard) > BYTES_IN:
            self.endpoint.dropped += 1
            heard = heard[:BYTES_IN]
        self._heard = heard

    def messages(self) -> list[Any]:
        """What has been heard, once."""
        heard, self._heard = self._heard, b""
        return self.endpoint.receive(heard)

    def take(self) -> bytes:
        """What the vehicle has said since the last call."""
        return self.endpoint.take()
