"""What an agent notices of its mates' radio: who has fallen silent, and whether frames are lost or late.

    mates = Mates(range_m=20.0, ttl_s=0.5)
    mates.hear(now_s, position_m, inbox)   # once a tick, while it plays
    mates.take_events()  # "no word from A3 for 1 s ..."

Who flies out of range is silent, too; that is no news. The rules of the algorithm do not ask: a silent mate's claims
end with their leases. This is for people, and for the report.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from comms.frames import Vec3
from comms.messages import Frame
from comms.status import Event, Level

SILENT_S = 1.0  # two leases of a tag; so many frames in a row are hardly ever lost by chance
NEAR = 0.75  # of the range: a mate that was so near has not flown out of it meanwhile
SOON_S = 5.0  # what is noticed of losses and delays fades as exp(-t / SOON_S)
LOSSY, WELL = 0.2, 0.1  # shares of frames that are lost: from when on it is told, and from when on no more
LATE, PROMPT = 0.5, 0.4  # ages of frames as they arrive, as shares of their time to live: likewise
ENOUGH = 20.0  # frames to judge by

SILENCE = "no word from"
RECEPTION = "reception is poor"


class Mates:
    """Who of an agent's mates is heard, and how well.

    Attributes:
        missing: mates that should be heard and are not.
    """

    def __init__(self, *, range_m: float, ttl_s: float) -> None:
        self._near_m = NEAR * range_m
        self._ttl_s = ttl_s
        self._last: dict[int, tuple[float, Frame]] = {}  # when each was heard last, and what it said
        self._heard = self._lost = self._age_s = 0.0  # all three fade
        self._faded_at_s = 0.0
        self._poor = False
        self._events: list[Event] = []
        self.missing: set[int] = set()

    def hear(self, now_s: float, position_m: Vec3, inbox: Sequence[Frame]) -> None:
        """Take in what arrived in this tick, sorted by sender and number, at this place."""
        self._fade(now_s)
        for frame in inbox:
            self._count(now_s, frame)
            self._last[frame.src] = (now_s, frame)
            if frame.src in self.missing:
                self.missing.remove(frame.src)
                self._say(Level.INFO, f"hears A{frame.src} again")
        if len(self._last) > len(inbox):
            self._look_for_silent(now_s, position_m)
        self._judge()

    def take_events(self) -> tuple[Event, ...]:
        """What was noticed since the last call."""
        events = tuple(self._events)
        self._events.clear()
        return events

    def _fade(self, now_s: float) -> None:
        stays = max(0.0, 1.0 - (now_s - self._faded_at_s) / SOON_S)
        self._faded_at_s = now_s
        self._heard, self._lost, self._age_s = self._heard * stays, self._lost * stays, self._age_s * stays

    def _count(self, now_s: float, frame: Frame) -> None:
        """Frames are numbered one by one, so a gap tells what was lost; a long one, that the mate was away."""
        self._heard += 1.0
        self._age_s += now_s - frame.sent_at_s
        at_s, before = self._last.get(frame.src, (now_s, frame))
        if now_s - at_s <= SILENT_S and frame.sent_at_s - before.sent_at_s <= SILENT_S:
            self._lost += max(0, frame.seq - before.seq - 1)

    def _look_for_silent(self, now_s: float, position_m: Vec3) -> None:
        for uid, (heard_at_s, frame) in self._last.items():
            silent_s = now_s - heard_at_s
            if silent_s <= SILENT_S or uid in self.missing:
                continue
            x, y, _ = frame.position_m
            east, north, _ = frame.velocity_m_s
            if hypot(x + silent_s * east - position_m[0], y + silent_s * north - position_m[1]) < self._near_m:
                self.missing.add(uid)
                self._say(Level.WARNING, f"{SILENCE} A{uid} for {SILENT_S:g} s, though it was near")
        # Who went away unnoticed may come back anywhere: it is nobody's loss.
        for uid in [uid for uid, (at_s, _) in self._last.items() if now_s - at_s > SILENT_S]:
            del self._last[uid]

    def _judge(self) -> None:
        if self._heard < ENOUGH:
            return
        loss = self._lost / (self._heard + self._lost)
        late = self._age_s / self._heard / self._ttl_s
        if not self._poor and (loss > LOSSY or late > LATE):
            self._poor = True
            self._say(
                Level.WARNING, f"{RECEPTION}: {loss:.0%} of mates' frames lost, {self._age_s / self._heard:.1f} s old"
            )
        elif self._poor and loss < WELL and late < PROMPT:
            self._poor = False
            self._say(Level.INFO, "reception is good again")

    def _say(self, level: Level, text: str) -> None:
        self._events.append(Event(level, text))
