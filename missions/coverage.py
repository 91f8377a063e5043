"""How much is seen: eq. 1 divided by n, as it grows tick by tick."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from itertools import repeat

_COUNT = "H"  # two bytes: a day of ticks is three megabytes


class Coverage:
    """Targets seen and targets present, tick by tick. Where targets come and go, sums of both are divided."""

    def __init__(self) -> None:
        self._seen = array(_COUNT)
        self._present = array(_COUNT)
        self._seen_in_all = 0
        self._present_in_all = 0

    def add(self, *, seen: int, present: int, tick: int | None = None) -> None:
        """Count one tick: the next, or that `tick` of the mission; between them nothing was to be seen."""
        missing = 0 if tick is None else max(0, tick - len(self._seen))
        self._seen.extend(repeat(0, missing))
        self._present.extend(repeat(0, missing))
        self._seen.append(seen)
        self._present.append(present)
        self._seen_in_all += seen
        self._present_in_all += present

    @property
    def by_tick(self) -> tuple[list[int], list[int]]:
        """Targets seen, and targets present, in each tick."""
        return list(self._seen), list(self._present)

    @property
    def now(self) -> float | None:
        """Share of the present targets seen in the last tick; None while there are none."""
        return _share(self._seen[-1:], self._present[-1:])

    @property
    def mean(self) -> float | None:
        """Share seen so far: A/n."""
        return self._seen_in_all / self._present_in_all if self._present_in_all else None

    @property
    def late(self) -> float | None:
        """The mean of the last quarter of the ticks."""
        start = len(self._seen) * 3 // 4
        return _share(self._seen[start:], self._present[start:])

    def between(self, first: int, end: int) -> float | None:
        """The mean of the ticks from `first` on and before `end`, as far as they were flown."""
        window = slice(max(0, first), max(0, end))
        return _share(self._seen[window], self._present[window])


def _share(seen: Sequence[int], present: Sequence[int]) -> float | None:
    return sum(seen) / sum(present) if sum(present) else None
