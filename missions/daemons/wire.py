"""Cues, dones and observations as MessagePack. Bad bytes decode to None, whatever they are."""

from __future__ import annotations

from typing import TypeVar

import msgspec

from comms.radio import Roster
from missions.daemons.believable import is_believable, most_done_bytes, shortened
from missions.observation import Observation
from missions.sides.exchange import Cue, Done

MAX_CUE_BYTES = 1_000_000
OVER = b""  # in place of a cue or an observation: the mission is over
# Why the world does not let a process in.
STRANGE = "has another mission, or another --speed, and is not let in: are its file and options the world's?"
TAKEN = "is there already, in another process, which goes on: a second one is not let in"
UNRELIABLE = "has left too many ticks unanswered, each of which everybody had to wait for: it is not let in again"
FOREIGN = "flies another world's mission, and comes home first: it is not let in"

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
    return _decoded(_cues, wire, MAX_CUE_BYTES)


def decode_done(wire: bytes, uid: int, roster: Roster) -> Done | None:
    """The done in `wire`, if it is one of agent `uid`, and can be believed in such a mission."""
    done = _decoded(_dones, wire, most_done_bytes(roster))
    return shortened(done) if done is not None and is_believable(done, uid, roster) else None


def decode_observation(wire: bytes, roster: Roster) -> Observation | None:
    """The observation in `wire`, if it is one of such a mission's: all that its agents say."""
    return _decoded(_observations, wire, (roster.n_agents + 1) * most_done_bytes(roster))


def _decoded(decoder: msgspec.msgpack.Decoder[T], wire: bytes, max_bytes: int) -> T | None:
    if len(wire) > max_bytes:
        return None
    try:
        return decoder.decode(wire)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return None
