"""Our packing and pymavlink's give the same bytes, for every message type of the dialect."""

from __future__ import annotations

import struct
from random import Random
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.packing import packed


def any_message(message_id: int, rng: Random) -> Any:
    """A message whose every byte is random, as somebody else would have sent it."""
    kind = dialect.mavlink_map[message_id]
    payload = rng.randbytes(kind.unpacker.size)
    head = struct.pack("<BBBBBBBHB", 0xFD, len(payload), 0, 0, 0, 1, 1, message_id & 0xFFFF, message_id >> 16)
    frame = head + payload
    crc = dialect.x25crc(frame[1:] + bytes((kind.crc_extra,))).crc
    return dialect.MAVLink(None).decode(bytearray(frame + struct.pack("<H", crc)))


def expected(message: Any, sequence: int) -> bytes:
    codec = dialect.MAVLink(None, srcSystem=7, srcComponent=9)
    codec.seq = sequence
    return bytes(message.pack(codec))


@pytest.mark.parametrize("message_id", sorted(dialect.mavlink_map))
def test_the_bytes_are_pymavlinks(message_id: int) -> None:
    rng = Random(message_id)
    for _ in range(5):
        message, sequence = any_message(message_id, rng), rng.randrange(256)
        assert packed(message, sequence=sequence, system_id=7, component_id=9) == expected(message, sequence)


def test_zeros_at_the_end_are_cut_but_the_first_byte_stays() -> None:
    nothing = dialect.MAVLink_system_time_message(0, 0)
    assert packed(nothing, sequence=0, system_id=7, component_id=9) == expected(nothing, 0)
    assert len(expected(nothing, 0)) == 10 + 1 + 2


def test_what_does_not_fit_raises() -> None:
    with pytest.raises(struct.error):
        packed(dialect.MAVLink_heartbeat_message(300, 0, 0, 0, 0, 0), sequence=0, system_id=1, component_id=1)
