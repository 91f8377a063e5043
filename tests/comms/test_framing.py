"""Where frames end: cutting a stream loses nothing, and cuts no frame."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comms.framing import MAX_FRAME_BYTES, datagrams, whole_bytes
from comms.mavlink import Endpoint
from tests.comms.test_mavlink import ATTITUDE, HEARTBEAT

FRAMES = st.lists(st.sampled_from([ATTITUDE, HEARTBEAT]), max_size=80)


@given(frames=FRAMES, kept=st.integers(0, len(HEARTBEAT) - 1))
def test_a_frame_begun_waits(frames: list[bytes], kept: int) -> None:
    whole = b"".join(frames)
    assert whole_bytes(whole + HEARTBEAT[:kept]) == len(whole)


def test_a_signed_frame_is_longer() -> None:
    signed = bytearray(HEARTBEAT + bytes(13))
    signed[2] = 0x01
    assert whole_bytes(signed) == len(signed)
    assert whole_bytes(signed[:-1]) == 0


def test_rubbish_does_not_wait() -> None:
    assert whole_bytes(b"GET / HTTP/1.1\r\n") == 16
    assert whole_bytes(b"") == 0


@given(noise=st.binary(max_size=3000), at_most=st.integers(MAX_FRAME_BYTES, 1400))
def test_datagrams_keep_every_byte_and_the_limit(noise: bytes, at_most: int) -> None:
    pieces = datagrams(noise, at_most=at_most)
    assert b"".join(pieces) == noise
    assert all(0 < len(piece) <= at_most for piece in pieces)


@given(frames=FRAMES)
def test_a_datagram_alone_holds_whole_frames(frames: list[bytes]) -> None:
    pieces = datagrams(b"".join(frames), at_most=300)
    ends = [Endpoint(system_id=255) for _ in pieces]
    assert sum(len(end.receive(piece)) for end, piece in zip(ends, pieces, strict=True)) == len(frames)
    assert all(end.bad == 0 for end in ends)


def test_a_limit_below_a_frame_is_a_mistake_of_ours() -> None:
    with pytest.raises(ValueError, match="280"):
        datagrams(b"", at_most=100)
