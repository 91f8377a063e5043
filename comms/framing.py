"""Where a MAVLink 2 frame begins and ends: its layout, told from the first three bytes and without any checksum."""

from __future__ import annotations

START = 0xFD
HEADER_BYTES = 10
CRC_BYTES = 2
SIGNATURE_BYTES = 13
SIGNED_FLAG = 0x01
MAX_FRAME_BYTES = HEADER_BYTES + 255 + CRC_BYTES + SIGNATURE_BYTES

_LENGTH_AT, _FLAGS_AT = 1, 2


def frame_bytes(data: bytes | bytearray, start: int) -> int | None:
    """How long the frame is whose start byte is at `start`; None while too little of it is there to tell."""
    if len(data) - start <= _FLAGS_AT:
        return None
    signature = SIGNATURE_BYTES if data[start + _FLAGS_AT] & SIGNED_FLAG else 0
    return HEADER_BYTES + data[start + _LENGTH_AT] + CRC_BYTES + signature


def whole_bytes(data: bytes | bytearray) -> int:
    """How much of a stream can be passed on without cutting a frame in two: its length, less a frame begun."""
    position = 0
    while (start := data.find(START, position)) >= 0:
        size = frame_bytes(data, start)
        if size is None or start + size > len(data):
            return start
        position = start + size
    return len(data)


def frames(data: bytes) -> tuple[list[bytes], bytes]:
    """The whole frames in a stretch of a stream, and a frame begun at its end; what lies between frames is left out."""
    found: list[bytes] = []
    position = 0
    while (start := data.find(START, position)) >= 0:
        size = frame_bytes(data, start)
        if size is None or start + size > len(data):
            return found, data[start:]
        found.append(data[start : start + size])
        position = start + size
    return found, b""


def datagrams(data: bytes, *, at_most: int) -> list[bytes]:
    """Whole frames in as few pieces as fit `at_most` bytes each, in order; what is no frame goes with its neighbor.

    A single frame always fits, for `at_most` is no less than MAX_FRAME_BYTES.
    """
    if at_most < MAX_FRAME_BYTES:
        raise ValueError(f"a frame may need {MAX_FRAME_BYTES} bytes, {at_most} are too few")
    pieces: list[bytes] = []
    while len(data) > at_most:
        cut = whole_bytes(data[:at_most]) or at_most
        pieces.append(data[:cut])
        data = data[cut:]
    return [*pieces, data] if data else pieces
