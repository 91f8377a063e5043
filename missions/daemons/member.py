"""One agent as the world knows it: which of its processes speaks for it, what that has told, and whether it is there.

Only a hello lets a process in, and only where none is there: where one is lost, has left or has never come. What
another one says is not heard. It may be the next life of one whose death has not been noticed yet, and so it is refused
only when the one that is there has spoken long after it came.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from msgspec import structs

from comms.session import LEASE_S
from comms.status import Activity, Event
from missions.sides.exchange import HELLO_TICK, Done, LinkCount, RadioTally

# What a process said before it died may be under way for a lease.
SURE_S = 1.5 * LEASE_S
MOST_RIVALS = 4  # that are remembered
MOST_LIVES = 8  # whose counts are told apart
MOST_NEWS = 1000  # while nobody asks, as while time stands still; the oldest go


@dataclass(frozen=True, slots=True)
class _Counts:
    """What is counted from the beginning of a life."""

    pilot: LinkCount
    vehicle: LinkCount
    radio: RadioTally

    def __add__(self, other: _Counts) -> _Counts:
        return _Counts(self.pilot + other.pilot, self.vehicle + other.vehicle, self.radio + other.radio)


class Member:
    """Agent `uid`. All times `now_s` are the crew's.

    Attributes:
        done: the last thing that was heard of it, without its events; None before its first hello.
        life: who speaks for it. is_there: and is to be cued. is_new: and has not been cued yet.
        news: events that nobody was told of. heard_at_s: when it last did something new. lost_at_s: when it was lost.
        awaited_in_vain: how often everybody waited until it was lost.
    """

    def __init__(self, uid: int) -> None:
        self.uid = uid
        self.done: Done | None = None
        self.life = 0
        self.is_there = False
        self.is_new = False
        self.news: deque[Event] = deque(maxlen=MOST_NEWS)
        self.heard_at_s = 0.0
        self.lost_at_s: float | None = None
        self.awaited_in_vain = 0
        self._spoke_at_s = 0.0
        self._newest = HELLO_TICK  # tick that it has told of
        self._own: _Counts | None = None
        self._counts: dict[int, _Counts] = {}  # of lives before this one
        self._former: _Counts | None = None  # all these together
        self._rivals: dict[int, float] = {}  # when they came, by life

    @property
    def last(self) -> Done:
        """What was heard last of one that has come."""
        assert self.done is not None
        return self.done

    def owes(self, tick: int) -> bool:
        """Whether it was cued for this tick, and its done is still to come."""
        return self.is_there and not self.is_new and self.last.tick != tick

    def greet(self, hello: Done, now_s: float) -> bool:
        """A process says hello: whether that lets it in."""
        if self.is_there:
            if hello.life == self.life:
                self._spoke_at_s = now_s  # again, before our cue came
            elif hello.life not in self._rivals:
                while len(self._rivals) >= MOST_RIVALS:
                    self._rivals.pop(next(iter(self._rivals)))
                self._rivals[hello.life] = now_s
            return False
        if hello.life != self.life:
            self._begin(hello.life)
        self.is_there, self.is_new, self.lost_at_s = True, True, None
        self._take(hello, now_s)
        return True

    def is_rival_in_vain(self, life: int) -> bool:
        """Whether this one waits for the death of one that is known to live."""
        came_at_s = self._rivals.get(life)
        return self.is_there and came_at_s is not None and self._spoke_at_s - came_at_s > SURE_S

    def hear(self, done: Done, now_s: float) -> None:
        """It has done a tick, or some other process says so, which is not heard.

        What is late, or comes of one that is lost, is told; but its place is known better by now.
        """
        if done.life != self.life:
            return
        self.news.extend(done.status.events)
        if self.is_there and done.tick > self._newest:
            self._newest = done.tick
            self._take(done, now_s)
            self.is_there = not done.leaves

    def has_spoken(self, tick: int) -> bool:
        """Whether it says that it has sent a frame in this tick."""
        return self.done is not None and self.done.tick == tick and self.done.spoke

    def unsay(self) -> None:
        """It has not sent the frame of this tick, whatever it says."""
        self.done = structs.replace(self.last, spoke=False)

    def lose(self, now_s: float) -> None:
        """It is not there any more, and nobody knows what it does."""
        self.is_there, self.lost_at_s = False, now_s
        status = self.last.status
        gone = structs.replace(status, activity=Activity.LOST, tags=(), calls=(), helping=None, mates=())
        self.done = structs.replace(self.last, status=gone, ready=False)

    def tell(self, tick: int, *, may_be_back: bool) -> Done:
        """What is known of it in this tick: its done, or its last one with nothing new but what came late."""
        done, status = self.last, self.last.status
        if done.tick != tick:
            done, status = structs.replace(done, spoke=False), structs.replace(status, knowledge=None)
        if not may_be_back:
            done = structs.replace(done, on_ground=True, unheard=True)
        if self.news:
            status = structs.replace(status, events=tuple(self.news))
            self.news.clear()
        return structs.replace(done, status=status)

    def _begin(self, life: int) -> None:
        """Another life: what the last one counted stays counted."""
        if self._own is not None:
            self._counts[self.life] = self._own
        while len(self._counts) > MOST_LIVES:
            oldest, second = list(self._counts)[:2]
            self._counts[second] += self._counts.pop(oldest)
        self._rivals.pop(life, None)
        self._counts.pop(life, None)  # it comes again, and has its counts with it
        former = iter(self._counts.values())
        first = next(former, None)
        self._former = None if first is None else sum(former, start=first)
        self.life, self._newest = life, HELLO_TICK

    def _take(self, done: Done, now_s: float) -> None:
        self.heard_at_s = self._spoke_at_s = now_s
        self._own = _Counts(done.pilot, done.vehicle, done.radio)
        counts = self._own if self._former is None else self._former + self._own
        self.done = structs.replace(
            done,
            status=structs.replace(done.status, events=()),
            pilot=counts.pilot,
            vehicle=counts.vehicle,
            radio=counts.radio,
        )
