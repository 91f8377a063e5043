"""A TCP port in front of a vehicle that lets everything through but one kind of message."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from comms.framing import START, frame_bytes
from comms.transport import Transport, transport_of


@contextmanager
def relay(vehicle_url: str, withheld: int | None) -> Iterator[str]:
    """`HOST:PORT` of a port that speaks for the vehicle at `vehicle_url` but for messages of the id `withheld`."""
    stop = threading.Event()
    with transport_of("tcpin:127.0.0.1:0") as client, transport_of(vehicle_url) as vehicle:
        thread = threading.Thread(target=_pass_on, args=(client, vehicle, withheld, stop), daemon=True)
        thread.start()
        try:
            yield client.url.removeprefix("tcpin:")
        finally:
            stop.set()
            thread.join(timeout=5.0)


def _pass_on(client: Transport, vehicle: Transport, withheld: int | None, stop: threading.Event) -> None:
    while not stop.wait(0.002):
        now_s = time.monotonic()
        for chunk in vehicle.read(now_s):
            client.write(without(chunk, withheld))
        for chunk in client.read(now_s):
            vehicle.write(chunk)


def without(frames: bytes, message_id: int | None) -> bytes:
    """Whole frames, less those of one message."""
    kept, position = bytearray(), 0
    while position < len(frames):
        size = frame_bytes(frames, position) if frames[position] == START else None
        if size is None:
            return bytes(kept) + frames[position:]
        frame = frames[position : position + size]
        if int.from_bytes(frame[7:10], "little") != message_id:
            kept += frame
        position += size
    return bytes(kept)
