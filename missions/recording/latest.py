"""Rows as time goes by: each is taken once, and of what holds until it changes the latest is kept."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Generic, TypeVar

T = TypeVar("T")


class Upcoming(Generic[T]):
    """Values that are still to come, in the order of their ticks."""

    def __init__(self) -> None:
        self._rows: Iterator[tuple[int, T]] = iter(())
        self._next: tuple[int, T] | None = None

    def add(self, rows: Iterable[tuple[int, T]]) -> None:
        """What comes after all that is here."""
        self._rows = chain(self._rows, rows)
        if self._next is None:
            self._next = next(self._rows, None)

    def until(self, tick: int) -> Iterator[T]:
        """Take those up to the tick, and of it."""
        while self._next is not None and self._next[0] <= tick:
            _, value = self._next
            self._next = next(self._rows, None)
            yield value


class Latest(Generic[T]):
    """A value that holds until the next one comes."""

    def __init__(self, before: T) -> None:
        self._value = before
        self._upcoming = Upcoming[T]()

    def add(self, rows: Iterable[tuple[int, T]]) -> None:
        """What comes after all that is here."""
        self._upcoming.add(rows)

    def at(self, tick: int) -> T:
        """What holds at the tick; ticks are asked for in rising order."""
        for value in self._upcoming.until(tick):
            self._value = value
        return self._value
