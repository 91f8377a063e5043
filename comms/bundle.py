"""What reaches one receiver at one tick, as one message: every frame, and of whom the air has heard it.

A process that hears nine neighbors is woken once, not nine times. The frames inside are not looked at here.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import msgspec

from comms.codec import MAX_FRAME_BYTES

MAX_FRAMES = 4096
MAX_BUNDLE_BYTES = MAX_FRAMES * (MAX_FRAME_BYTES + 16)  # longer input is not looked at

Heard = tuple[int, bytes]  # of whom, and the frame

_Bundle = Annotated[list[tuple[Annotated[int, msgspec.Meta(ge=0)], bytes]], msgspec.Meta(max_length=MAX_FRAMES)]

_encoder = msgspec.msgpack.Encoder()
_decoder = msgspec.msgpack.Decoder(_Bundle)


def bundle(frames: Sequence[Heard]) -> bytes:
    """The wire form of these frames, in this order; of more than MAX_FRAMES the first go."""
    return _encoder.encode(frames[-MAX_FRAMES:])


def unbundle(wire: bytes) -> list[Heard] | None:
    """The frames in `wire`, or None if it is anything else than one whole bundle."""
    if len(wire) > MAX_BUNDLE_BYTES:
        return None
    try:
        return _decoder.decode(wire)
    except (msgspec.DecodeError, RecursionError):
        return None
