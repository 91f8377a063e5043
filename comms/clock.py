"""The pace of the mission clock. Time itself is tick x tick_s; this only decides how long the wall clock must wait."""

from __future__ import annotations

import time
from typing import Protocol


class Pace(Protocol):
    """Called at the beginning of every tick; returns how late (s, wall clock) that tick begins."""

    def begin(self, tick: int) -> float: ...


class Awake:
    """Seconds in which this process could look: a sleep that it did not ask for counts for `most_s` at most.

    Who measures another's silence with it does not take its own for that. It must be read more often than `most_s`.
    """

    def __init__(self, *, most_s: float) -> None:
        self._most_s = most_s
        self._read_at_s = time.monotonic()
        self._awake_s = 0.0

    def now_s(self) -> float:
        """Since it was made."""
        now_s = time.monotonic()
        self._awake_s += min(now_s - self._read_at_s, self._most_s)
        self._read_at_s = now_s
        return self._awake_s


class Lockstep:
    """As fast as possible: every tick begins when the one before it is done, and is never late."""

    def begin(self, tick: int) -> float:
        return 0.0


class RealTime:
    """Ticks on the wall clock, `speed` times as fast. A late tick is not skipped; its lateness is told."""

    def __init__(self, *, tick_s: float, speed: float) -> None:
        if speed <= 0.0:
            raise ValueError(f"speed is a number above 0, not {speed}")
        self._period_s = tick_s / speed
        self._first: tuple[int, float] | None = None

    def begin(self, tick: int) -> float:
        now_s = time.monotonic()
        if self._first is None:
            self._first = (tick, now_s)
        first_tick, first_s = self._first
        due_s = first_s + (tick - first_tick) * self._period_s
        if now_s < due_s:
            time.sleep(due_s - now_s)
            return 0.0
        return now_s - due_s
