"""Cues, dones and observations as MessagePack. Bad bytes decode to None, whatever they are."""

from __future__ import annotations

from math import isfinite
from typing import TypeVar

import msgspec

from comms.messages import FARTHEST_M, FASTEST_M_S
from missions.observation import Observation
from missions.sides.exchange import Cue, Done

MAX_BYTES = 1_000_000
OVER = b""  # in place of a cue or an observation: the mission is over
# Why the world does not let a process in.
STRANGE = "has another mission, or another --speed, and is not let in: are its file and options the world's?"
TAKEN = "is there already, in another process, which goes on: a second one is not let in"

T = TypeVar("T")

_encoder = msgspec.msgpack.Encoder()
_cues = msgspec.msgpack.Decoder(Cue)
_dones = msgspec.msgpack.Decoder(Done)
_observations = msgspec.msgpack.Decoder(Observation)


def encode(value: Cue | Done | Observation) -> bytes:
    """Its wire form."""
    return _encoder.encode(value)


def decode_cue(wire: bytes) -> Cue | None:
    """The cue in `wire`, if it is one."""
    return _decoded(_cues, wire)


def decode_done(wire: bytes, uid: int) -> Done | None:
    """The done in `wire`, if it is one of agent `uid` and of a vehicle that is somewhere."""
    done = _decoded(_dones, wire)
    if done is None or done.status.uid != uid:
        return None
    truth = done.truth
    near = all(abs(place) <= FARTHEST_M for place in truth.position_m)
    slow = all(abs(speed) <= FASTEST_M_S for speed in truth.velocity_m_s)
    return done if near and slow and isfinite(truth.heading_rad) else None  # NaN is neither


def decode_observation(wire: bytes) -> Observation | None:
    """The observation in `wire`, if it is one."""
    return _decoded(_observations, wire)


def _decoded(decoder: msgspec.msgpack.Decoder[T], wire: bytes) -> T | None:
    if len(wire) > MAX_BYTES:
        return None
    try:
        return decoder.decode(wire)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return None
