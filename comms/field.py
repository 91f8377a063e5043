"""A radio without an air: every mate is heard directly, as far as the radios themselves reach.

Frames then come at any moment of a tick, and from several clocks. An agent hears what was said before its tick began;
the rest waits for its next one. So a mission in lockstep goes the same way whoever is faster.

There everybody says one frame a tick, and who says more is not heard more often: anybody can put anything on the air.
"""

from __future__ import annotations

from math import inf, nan

from comms.keys import Keys, sender
from comms.messages import Frame
from comms.radio import EARLY_S, MAX_WAITING, Radio, Roster, decode_once, kept
from comms.session import Bus
from comms.turns import Turns

_SAME_S = 0.001  # frames tell their time to the millisecond


class FieldRadio(Radio):
    """Agent `uid`'s radio where all hear each other: it takes what its mates say, and not what it says itself."""

    is_open = True

    def __init__(self, bus: Bus, *, keys: Keys, uid: int, roster: Roster, ttl_s: float = inf) -> None:
        self._said = Turns(roster.n_agents)
        self._one_each: dict[int, bytes] = {}  # by sender, what counts of the tick that was asked for
        self._asked_s = nan
        super().__init__(bus, keys=keys, uid=uid, roster=roster, ttl_s=ttl_s)

    def waiting(self, now_s: float) -> int:
        """How many frames have arrived that can be heard by now, and were not drained yet: one of a sender and tick.

        In lockstep alone is this asked. Of more the newest frame stays, or something that is none if there is no frame:
        its sender has spoken, and nobody need wait for it. The rest is refused.
        """
        if now_s != self._asked_s:
            self._close_tick()
            self._asked_s, self.surplus = now_s, 0
        for src, payload in self._come(now_s):
            former = self._one_each.get(src)
            if former is not None:
                self.surplus += 1
                self.count.strange += 1
            if former is None or _number(src, payload) > _number(src, former):
                self._one_each[src] = payload
        return min(len(self._arrived) + len(self._one_each), MAX_WAITING)

    def forget(self, now_s: float) -> None:
        """Be as new: nothing waits that could be heard by now, and nobody has been heard."""
        self._come(now_s)
        self._one_each.clear()
        super().forget(now_s)

    def drain(self, now_s: float) -> list[Frame]:
        """The believable frames that were sent before now, since the last call, sorted by (src, seq).

        Those that were counted, if they were: what has come since then waits.
        """
        self._close_tick()
        if now_s != self._asked_s:
            self._arrived.extend(self._come(now_s))
        return super().drain(now_s)

    def _heard_at(self, keys: Keys) -> str:
        return keys.every_tx

    def _hear(self, key: str, payload: bytes) -> None:
        src = sender(key)
        if src != self.uid and not self._said.put(src, kept(payload)):
            self.count.strange += 1

    def _close_tick(self) -> None:
        self._arrived.extend(self._one_each.items())
        self._one_each.clear()

    def _come(self, now_s: float) -> list[tuple[int, bytes]]:
        """What was sent before now; what is of this tick, or of a clock that is ahead, waits."""
        come = []
        for src, payload in self._said.take():
            if _is_ahead(payload, now_s):
                self._said.put(src, payload)
            else:
                come.append((src, payload))
        return come


def _is_ahead(payload: bytes, now_s: float) -> bool:
    frame = decode_once(payload)
    return frame is not None and -_SAME_S <= frame.sent_at_s - now_s <= EARLY_S


def _number(src: int, payload: bytes) -> int:
    """Of the sender's frame; below all others if it is none."""
    frame = decode_once(payload)
    return -1 if frame is None or frame.src != src else frame.seq
