"""An agent's radio: the small port through which it speaks and hears. What arrives is checked before it is believed."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from functools import lru_cache
from math import inf
from typing import NamedTuple

from comms import codec
from comms.bundle import MAX_FRAMES, Heard, unbundle
from comms.keys import Keys
from comms.messages import Frame
from comms.session import Bus

EARLY_S = 0.5  # clocks of computers that keep time by themselves may differ so much
MAX_WAITING = MAX_FRAMES  # beyond it the oldest go: a radio that nobody drains must not eat the memory

NOISE: Heard = (0, b"")  # something that is no frame

# Within one process a frame reaches several agents as the same bytes: decode it once.
decode_once = lru_cache(maxsize=1024)(codec.decode)


class Roster(NamedTuple):
    """Whom a mission has: agents and targets are numbered from 0."""

    n_agents: int = codec.MAX_TARGETS
    n_targets: int = codec.MAX_TARGETS

    def has_all_of(self, frame: Frame) -> bool:
        """Whether the mission has who speaks, and every target that is spoken of."""
        if frame.src >= self.n_agents:
            return False
        for words in (frame.tags, frame.help_calls, frame.answers):
            for word in words:
                if word[0] >= self.n_targets:
                    return False
        return True


ANYBODY = Roster()


@dataclass(slots=True)
class RadioCount:
    """What was sent so far, and what arrived: accepted frames, and those refused, by reason."""

    sent: int = 0
    bytes: int = 0
    accepted: int = 0
    bad: int = 0  # not a frame, or not of whom the air has heard it
    strange: int = 0  # of an agent, or about a target, that the mission does not have; or one of too many at once
    stale: int = 0  # older than its own time to live, or the mission's
    early: int = 0  # from the future: what it claims would hold until then
    replayed: int = 0  # sequence number not above the last one heard from that sender

    @property
    def refused(self) -> int:
        """All that was not believed."""
        return self.bad + self.strange + self.stale + self.early + self.replayed


class Radio:
    """Agent `uid`'s radio on a bus: `send` a frame, `drain` what has arrived.

    Args:
        roster: who can be heard, and heard of. ttl_s: nothing older is believed, whatever its speaker says.

    Attributes:
        is_open: whether more may arrive than the world knows of. surplus: so many were refused as they were counted,
            because their senders had spoken already in the tick.
    """

    is_open = False
    surplus = 0

    def __init__(self, bus: Bus, *, keys: Keys, uid: int, roster: Roster = ANYBODY, ttl_s: float = inf) -> None:
        self.uid = uid
        self._roster = roster
        self._ttl_s = ttl_s
        self._put = bus.publisher(keys.tx(uid))
        self._arrived: deque[Heard] = deque(maxlen=MAX_WAITING)
        self._last_seq: dict[int, int] = {}
        self.count = RadioCount()
        bus.subscribe(self._heard_at(keys), self._hear)

    def waiting(self, now_s: float) -> int:
        """How many frames have arrived that can be heard by now, and were not drained yet."""
        return len(self._arrived)

    def send(self, frame: Frame) -> None:
        """Speak: one frame, to whoever is in range."""
        payload = codec.encode(frame)
        self.count.sent += 1
        self.count.bytes += len(payload)
        self._put(payload)

    def forget(self, now_s: float) -> None:
        """Be as new: nothing waits, and nobody has been heard. What a computer that goes out does to its radio."""
        self._arrived.clear()
        self._last_seq.clear()

    def drain(self, now_s: float) -> list[Frame]:
        """The believable frames since the last call, sorted by (src, seq). Never raises on what arrived."""
        frames = []
        while self._arrived:
            src, payload = self._arrived.popleft()
            frame = decode_once(payload)
            if frame is None or frame.src != src:
                self.count.bad += 1
            elif not self._roster.has_all_of(frame):
                self.count.strange += 1
            elif now_s - frame.sent_at_s > min(frame.ttl_s, self._ttl_s):
                self.count.stale += 1
            elif frame.sent_at_s - now_s > EARLY_S:
                self.count.early += 1
            else:
                frames.append(frame)
        frames.sort(key=_by_sender)
        fresh = [frame for frame in frames if self._is_new(frame)]
        self.count.accepted += len(fresh)
        return fresh

    def _heard_at(self, keys: Keys) -> str:
        return keys.rx(self.uid)

    def _hear(self, key: str, payload: bytes) -> None:
        heard = unbundle(payload)
        self._arrived.extend([NOISE] if heard is None else [(src, kept(frame)) for src, frame in heard])

    def _is_new(self, frame: Frame) -> bool:
        if frame.seq <= self._last_seq.get(frame.src, -1):
            self.count.replayed += 1
            return False
        self._last_seq[frame.src] = frame.seq
        return True


def kept(payload: bytes) -> bytes:
    """What is kept of what arrived: what is too long to be a frame is not, and counts as one that is none."""
    return payload if len(payload) <= codec.MAX_FRAME_BYTES else b""


def _by_sender(frame: Frame) -> tuple[int, int]:
    return frame.src, frame.seq
