"""Frames to bytes and back: MessagePack arrays of integers, checked against a schema on the way in.

Bad bytes decode to None, whatever they are. Ten tags and nine help calls fit into 512 bytes.
"""

from __future__ import annotations

from typing import Annotated

import msgspec

from comms.messages import (
    FARTHEST_M,
    FASTEST_M_S,
    MAX_ANSWERS,
    MAX_CALLS,
    MAX_TAGS,
    VERSION,
    Answer,
    Frame,
    HelpCall,
    Tag,
    thousandths,
)

MAX_FRAME_BYTES = 4096  # nobody needs more; longer input is not looked at
MAX_TARGETS = 65_536

_Id = Annotated[int, msgspec.Meta(ge=0, lt=MAX_TARGETS)]
_Millimeters = Annotated[int, msgspec.Meta(ge=-1000 * FARTHEST_M, le=1000 * FARTHEST_M)]
_MillimetersPerSecond = Annotated[int, msgspec.Meta(ge=-1000 * FASTEST_M_S, le=1000 * FASTEST_M_S)]
_Distance = Annotated[int, msgspec.Meta(ge=0, le=2000 * FARTHEST_M)]
_Span = Annotated[int, msgspec.Meta(ge=0, le=86_400_000)]  # up to a day
_Instant = Annotated[int, msgspec.Meta(ge=0, le=2**53)]

_WirePoint = tuple[_Millimeters, _Millimeters, _Millimeters]
_WireVelocity = tuple[_MillimetersPerSecond, _MillimetersPerSecond, _MillimetersPerSecond]
_WireTag = tuple[_Id, _Millimeters, _Millimeters, _MillimetersPerSecond, _MillimetersPerSecond, _Distance]
_WireCall = tuple[_Id, _Millimeters, _Millimeters, _MillimetersPerSecond, _MillimetersPerSecond, _Span, _Span]
_WireAnswer = tuple[_Id, _Span]
_WireFrame = tuple[
    Annotated[int, msgspec.Meta(ge=VERSION, le=VERSION)],
    _Id,
    Annotated[int, msgspec.Meta(ge=0, lt=2**53)],
    _Instant,
    _Span,
    _WirePoint,
    _WireVelocity,
    Annotated[list[_WireTag], msgspec.Meta(max_length=MAX_TAGS)],
    Annotated[list[_WireCall], msgspec.Meta(max_length=MAX_CALLS)],
    Annotated[list[_WireAnswer], msgspec.Meta(max_length=MAX_ANSWERS)],
]

_encoder = msgspec.msgpack.Encoder()
_decoder = msgspec.msgpack.Decoder(_WireFrame)


def encode(frame: Frame) -> bytes:
    """The frame's wire form. A value that no receiver would accept (not finite, out of range) raises ValueError."""
    t = thousandths
    x, y, z = frame.position_m
    vx, vy, vz = frame.velocity_m_s
    try:
        wire = _encoder.encode(
            (
                VERSION,
                frame.src,
                frame.seq,
                t(frame.sent_at_s),
                t(frame.ttl_s),
                (t(x), t(y), t(z)),
                (t(vx), t(vy), t(vz)),
                [(g.target, t(g.x_m), t(g.y_m), t(g.vx_m_s), t(g.vy_m_s), t(g.distance_m)) for g in frame.tags],
                [
                    (c.target, t(c.x_m), t(c.y_m), t(c.vx_m_s), t(c.vy_m_s), t(c.loss_in_s), t(c.seen_ago_s))
                    for c in frame.help_calls
                ],
                [(a.target, t(a.capture_s)) for a in frame.answers],
            )
        )
        _decoder.decode(wire)  # our own misuse is loud, here and not at the receiver
    except (ValueError, OverflowError) as error:
        raise ValueError(f"frame {frame.seq} of agent {frame.src} cannot be sent: {error}") from error
    return wire


def decode(wire: bytes) -> Frame | None:
    """The frame in `wire`, or None if it is anything else than one whole, plausible frame of this version."""
    if len(wire) > MAX_FRAME_BYTES:
        return None
    try:
        _, src, seq, sent, ttl, (x, y, z), (vx, vy, vz), tags, calls, answers = _decoder.decode(wire)
    except (msgspec.DecodeError, RecursionError):
        return None
    return Frame(
        src,
        seq,
        sent / 1000.0,
        ttl / 1000.0,
        (x / 1000.0, y / 1000.0, z / 1000.0),
        (vx / 1000.0, vy / 1000.0, vz / 1000.0),
        tuple([Tag(j, a / 1000.0, b / 1000.0, c / 1000.0, d / 1000.0, e / 1000.0) for j, a, b, c, d, e in tags]),
        tuple(
            [
                HelpCall(j, a / 1000.0, b / 1000.0, c / 1000.0, d / 1000.0, e / 1000.0, f / 1000.0)
                for j, a, b, c, d, e, f in calls
            ]
        ),
        tuple([Answer(j, a / 1000.0) for j, a in answers]),
    )
