"""One link of a vehicle: an autopilot answers on the link it was asked on, and every link has rates of its own."""

from __future__ import annotations

from typing import Any

from comms.mavlink import Endpoint
from vehicle_sim.autopilot.streams import Streams

BYTES_A_TICK = 65_536  # more than this from one link in one tick is dropped


class Channel:
    """What a vehicle knows of one of its links.

        channel.hear(wire_in)        # before the vehicle's tick
        wire_out = channel.take()    # after it

    Attributes:
        endpoint: with sequence numbers of its own. streams: what the other side asked for.
        dropped: bytes beyond BYTES_A_TICK.
    """

    def __init__(self, *, system_id: int, started_at_s: float) -> None:
        self.endpoint = Endpoint(system_id=system_id)
        self.streams = Streams(started_at_s=started_at_s)
        self.dropped = 0
        self._heard = b""

    def hear(self, wire: bytes) -> None:
        """Bytes that the vehicle takes in at its next tick."""
        heard = self._heard + wire if self._heard else wire
        if len(heard) > BYTES_A_TICK:
            self.dropped += len(heard) - BYTES_A_TICK
            heard = heard[:BYTES_A_TICK]
        self._heard = heard

    def messages(self) -> list[Any]:
        """What has been heard, once."""
        heard, self._heard = self._heard, b""
        return self.endpoint.receive(heard)

    def take(self) -> bytes:
        """What the vehicle has said since the last call."""
        return self.endpoint.take()
