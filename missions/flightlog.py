"""Telemetry logs read back: what MAVProxy, QGroundControl or `swarm launch --tlog` kept of a link.

A frame lies behind eight bytes, microseconds since 1970, big-endian. What is no such entry (a torn end, a bad disk) is
stepped over and counted.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from mmap import mmap

from comms.framing import MAX_FRAME_BYTES, frame_bytes
from comms.framing import START as START_2
from comms.mavlink import LogDecoder, Message

_STAMP = struct.Struct(">Q")
_START_1, _FRAME_1_BYTES = 0xFE, 8  # of MAVLink 1: its start byte, and a frame's bytes beside its payload
# Times are believed between 2000 and 2100: a stretch of rubbish hardly ever looks like one of those.
_FIRST_US, _LAST_US = 946_684_800_000_000, 4_102_444_800_000_000


@dataclass(frozen=True, slots=True)
class Entry:
    """One message and when it passed, seconds since 1970."""

    unix_s: float
    message: Message


class FlightLog:
    """A log's messages in order of the file, one after the other, so that a log may be larger than memory.

    Reading never raises, whatever the bytes are.

    Attributes:
        messages, skipped_bytes: messages that were read so far, and bytes that were none.
        back_s: how far its time went back, where that was farthest: a computer's clock was set, or it is two logs.
    """

    def __init__(self, data: bytes | mmap) -> None:
        self._data = data
        self._decoder = LogDecoder()
        self.messages = 0
        self.skipped_bytes = 0
        self.back_s = 0.0

    def __iter__(self) -> Iterator[Entry]:
        data, position, latest_s = self._data, 0, 0.0
        while position < len(data):
            size = _entry_bytes(data, position)
            message = None if size is None else self._decoder.decoded(data[position + _STAMP.size : position + size])
            if size is None or message is None:
                position += 1
                self.skipped_bytes += 1
                continue
            self.messages += 1
            unix_s = _STAMP.unpack_from(data, position)[0] / 1e6
            latest_s = max(latest_s, unix_s)
            self.back_s = max(self.back_s, latest_s - unix_s)
            yield Entry(unix_s, message)
            position += size


def _entry_bytes(data: bytes | mmap, position: int) -> int | None:
    """How long the entry is that begins here; None if none can."""
    start = position + _STAMP.size
    if start + _FRAME_1_BYTES > len(data) or data[start] not in (_START_1, START_2):
        return None
    if not _FIRST_US < _STAMP.unpack_from(data, position)[0] < _LAST_US:
        return None
    frame = (
        data[start + 1] + _FRAME_1_BYTES
        if data[start] == _START_1
        else frame_bytes(data[start : start + MAX_FRAME_BYTES], 0)
    )
    return None if frame is None or start + frame > len(data) else _STAMP.size + frame
