"""A radio without an air: every mate is heard directly, as far as the radios themselves reach.

Frames then come at any moment of a tick, and from several clocks. An agent hears what was said before its tick began;
the rest waits for its next one. So a mission in lockstep goes the same way whoever is faster.
"""

from __future__ import annotations

from math import inf

from comms.keys import Keys, sender
from comms.messages import Frame
from comms.radio import EARLY_S, Radio, Roster, decode_once, kept
from comms.session import Bus
from comms.turns import Turns

_SAME_S = 0.001  # frames tell their time to the millisecond


class FieldRadio(Radio):
    """Agent `uid`'s radio where all hear each other: it takes what its mates say, and not what it says itself."""

    def __init__(self, bus: Bus, *, keys: Keys, uid: int, roster: Roster, ttl_s: float = inf) -> None:
        self._said = Turns(roster.n_agents)
        super().__init__(bus, keys=keys, uid=uid, roster=roster, ttl_s=ttl_s)

    def waiting(self, now_s: float) -> int:
        """How many frames have arrived that can be heard by now, and were not drained yet."""
        self._settle(now_s)
        return super().waiting(now_s)

    def forget(self, now_s: float) -> None:
        """Be as new: nothing waits that could be heard by now, and nobody has been heard."""
        self._settle(now_s)
        super().forget(now_s)

    def drain(self, now_s: float) -> list[Frame]:
        """The believable frames that were sent before now, since the last call, sorted by (src, seq)."""
        self._settle(now_s)
        return super().drain(now_s)

    def _heard_at(self, keys: Keys) -> str:
        return keys.every_tx

    def _hear(self, key: str, payload: bytes) -> None:
        src = sender(key)
        if src != self.uid and not self._said.put(src, kept(payload)):
            self.count.strange += 1

    def _settle(self, now_s: float) -> None:
        """Let arrive what was sent before now; what is of this tick, or of a clock that is ahead, waits."""
        for src, payload in self._said.take():
            if _is_ahead(payload, now_s):
                self._said.put(src, payload)
            else:
                self._arrived.append((src, payload))


def _is_ahead(payload: bytes, now_s: float) -> bool:
    frame = decode_once(payload)
    return frame is not None and -_SAME_S <= frame.sent_at_s - now_s <= EARLY_S
