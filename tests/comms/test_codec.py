"""Frames survive the wire, rounded to thousandths; everything else is refused without a word."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comms.codec import decode, encode
from comms.messages import MAX_ANSWERS, MAX_CALLS, MAX_TAGS, Answer, Frame, HelpCall, Tag, on_wire

meters = st.floats(-90_000, 90_000).map(on_wire)
speeds = st.floats(-400, 400).map(on_wire)
spans = st.floats(0, 3600).map(on_wire)
targets = st.integers(0, 999)
frames = st.builds(
    Frame,
    src=st.integers(0, 249),
    seq=st.integers(0, 2**40),
    sent_at_s=spans,
    ttl_s=spans,
    position_m=st.tuples(meters, meters, meters),
    velocity_m_s=st.tuples(speeds, speeds, speeds),
    tags=st.lists(st.builds(Tag, targets, meters, meters, speeds, speeds, spans), max_size=12).map(tuple),
    help_calls=st.lists(st.builds(HelpCall, targets, meters, meters, speeds, speeds, spans, spans), max_size=9).map(
        tuple
    ),
    answers=st.lists(st.builds(Answer, targets, spans), max_size=2).map(tuple),
)
PLAIN = Frame(3, 7, 1.5, 0.5, (1.0, 2.0, 12.0), (0.1, 0.0, 0.0), (Tag(4, 1.0, 2.5, 0.3, 0.0, 0.75),))


@given(frames)
def test_a_frame_comes_back_equal(frame: Frame) -> None:
    assert decode(encode(frame)) == frame


def test_values_are_rounded_to_thousandths() -> None:
    frame = decode(encode(PLAIN._replace(position_m=(1.00049, -1.00051, 0.0005))))
    assert frame is not None
    assert frame.position_m == (1.0, -1.001, 0.001)


def test_ten_tags_and_nine_calls_fit_into_512_bytes() -> None:
    far, fast = -29_999.999, -9.999
    frame = Frame(
        249,
        10**6,
        86_400.0,
        0.6,
        (far, far, 120.0),
        (fast, fast, fast),
        tuple(Tag(900 + j, far, far, fast, fast, 60.0) for j in range(10)),
        tuple(HelpCall(900 + j, far, far, fast, fast, 20.0, 0.0) for j in range(9)),
        (Answer(900, 60.0),),
    )
    assert len(encode(frame)) <= 512


def test_the_fullest_frame_is_heard() -> None:
    far, fast = -99_999.999, -499.999
    frame = Frame(
        60_000,
        2**40,
        10**7,
        86_400.0,
        (far, far, far),
        (fast, fast, fast),
        tuple(Tag(60_000 + j, far, far, fast, fast, 199_999.999) for j in range(MAX_TAGS)),
        tuple(HelpCall(60_000 + j, far, far, fast, fast, 86_400.0, 86_400.0) for j in range(MAX_CALLS)),
        tuple(Answer(60_000 + j, 86_400.0) for j in range(MAX_ANSWERS)),
    )
    assert decode(encode(frame)) == frame


@given(st.binary(max_size=200))
def test_rubbish_is_none(wire: bytes) -> None:
    assert decode(wire) is None


@given(st.data())
def test_a_damaged_frame_never_raises(data: st.DataObject) -> None:
    wire = bytearray(encode(PLAIN))
    for _ in range(data.draw(st.integers(1, 4))):
        wire[data.draw(st.integers(0, len(wire) - 1))] = data.draw(st.integers(0, 255))
    decode(bytes(wire))
    assert decode(bytes(wire[:-1])) is None


@pytest.mark.parametrize(
    ("change", "value"),
    [
        (0, 2),  # another version
        (1, -1),  # nobody
        (2, "7"),  # a sequence number that is text
        (3, -1),  # before the clock began
        (5, (10**9, 0, 0)),  # a thousand kilometers away
        (6, (0, 0)),  # two of three components
        (7, [(4, 0, 0, 0, 0, -1)]),  # a negative distance
        (7, [(4, 0, 0, 0, 0)]),  # a tag without its distance
        (8, [(4, 0, 0, 0, 0, 1.5, 0)]),  # a float where milliseconds belong
        (9, [(4, 0)] * 1000),  # more answers than anybody gives
    ],
)
def test_a_frame_that_breaks_the_schema_is_none(change: int, value: object) -> None:
    fields: list[object] = msgspec.msgpack.decode(encode(PLAIN))
    assert decode(msgspec.msgpack.encode(fields)) == PLAIN
    fields[change] = value
    assert decode(msgspec.msgpack.encode(fields)) is None


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), 1e9])
def test_our_own_nonsense_is_loud(bad: float) -> None:
    with pytest.raises(ValueError, match="frame 7 of agent 3 cannot be sent"):
        encode(PLAIN._replace(position_m=(bad, 0.0, 0.0)))
