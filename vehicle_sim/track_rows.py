"""The rows of a CSV of tracks, before they share a clock and a plane: each animal's fixes as the file has them.

A malformed row is an error, never skipped in silence. Normal are blank lines, empty positions (a receiver without
satellites) and, in Movebank's files, rows in any order; of two rows with one animal and time the later wins.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from math import nan
from operator import itemgetter

MAX_PROBLEMS = 10
_SHOWN_CHARACTERS = 40
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_MICROSECOND = timedelta(microseconds=1)

Place = tuple[float, float]  # east and north, in the file's unit


class TracksError(ValueError):
    """A file without usable tracks: each of `problems` says where, what was found and what is allowed."""

    def __init__(self, source: str, problems: Sequence[str]) -> None:
        super().__init__(source, problems)
        self.source = source
        self.problems = tuple(problems)

    def __str__(self) -> str:
        return "\n".join(f"{self.source}: {problem}" for problem in self.problems)


class _BadRowError(ValueError):
    """What is wrong with one row, and what is allowed."""


def _number(text: str, column: str, limit: float) -> float:
    try:
        value = float(text)
    except ValueError:
        value = nan
    if -limit <= value <= limit:  # neither nan nor inf passes
        return value
    raise _BadRowError(f"{column} is {_shown(text)}; allowed: a number from {-limit:g} to {limit:g}")


def _seconds(text: str, column: str) -> float:
    return _number(text, column, 1e10)  # a clock in milliseconds since 1970 is refused


def _utc_microseconds(text: str, column: str) -> float:
    try:
        stamp = datetime.fromisoformat(text)
    except ValueError:
        allowed = "a date and time such as 2012-08-05 03:00:54.999 (UTC)"
        raise _BadRowError(f"{column} is {_shown(text)}; allowed: {allowed}") from None
    if stamp.tzinfo is None:
        stamp = stamp.replace(tzinfo=UTC)
    return (stamp - _EPOCH) // _MICROSECOND  # an integer, so that differences are exact


def _shown(text: str) -> str:
    return repr(text if len(text) <= _SHOWN_CHARACTERS else text[:_SHOWN_CHARACTERS] + "...")


@dataclass(frozen=True, slots=True)
class Layout:
    """One kind of file: its columns, how to read its clock, and what its positions may be.

    Attributes:
        columns: the names of time, animal, east and north. limits: the largest size of east and of north.
        ticks, ticks_per_s: reads a time (given the column's name for errors), and the unit of the result.
        ordered: whether it is an error when an animal's time goes back.
        geographic: whether east and north are WGS84 degrees; else ENU meters.
    """

    columns: tuple[str, str, str, str]
    limits: tuple[float, float]
    ticks: Callable[[str, str], float]
    ticks_per_s: float
    ordered: bool
    geographic: bool


LAYOUTS = (
    Layout(("t", "id", "x", "y"), (1e7, 1e7), _seconds, 1.0, ordered=True, geographic=False),
    Layout(
        ("timestamp", "individual-local-identifier", "location-long", "location-lat"),
        (180.0, 90.0),
        _utc_microseconds,
        1e6,
        ordered=False,
        geographic=True,
    ),
)


@dataclass(slots=True, kw_only=True)
class Rows:
    """What a file holds: for each animal its places by time, in the file's units (see `layout`), and two counts.

    `empty_positions` counts rows without a place, `placed` those with one.
    """

    layout: Layout
    fixes: dict[str, dict[float, Place]] = field(default_factory=dict)
    empty_positions: int = 0
    placed: int = 0

    @property
    def repeated_times(self) -> int:
        """Rows overruled by a later one of the same animal and time."""
        return self.placed - sum(map(len, self.fixes.values()))

    def add(self, animal: str, ticks: float, place: Place | None) -> None:
        """Take one row in, the next of the file. `place` is None where the position is empty."""
        own = self.fixes.setdefault(animal, {})
        if self.layout.ordered and own and ticks < (last := next(reversed(own))):
            raise _BadRowError(f"t of {_shown(animal)} goes back from {last:g} to {ticks:g}; allowed: never back")
        if place is None:
            self.empty_positions += 1
        else:
            self.placed += 1
            own[ticks] = place


def parse_rows(text: str, *, source: str) -> Rows:
    """The rows of a CSV; `source` names it in errors.

    Raises:
        TracksError: other columns than a layout's, broken quotes, or bad rows (the first ten are listed).
    """
    lines = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True, strict=True)
    problems: list[str] = []
    try:
        header = next(lines, [])
        layout, pick = _layout(header)
        rows = Rows(layout=layout)
        for line in filter(None, lines):  # a blank line is an empty list
            try:
                if len(line) != len(header):
                    raise _BadRowError(f"{len(line)} fields; allowed: {len(header)}, as in the header")
                rows.add(*_fix(layout, pick(line)))
            except _BadRowError as problem:
                problems.append(f"line {lines.line_num}: {problem}")
                if len(problems) == MAX_PROBLEMS:
                    problems.append(f"reading stopped at {MAX_PROBLEMS} problems")
                    break
    except _BadRowError as problem:
        problems.append(f"line 1: {problem}")
    except csv.Error as error:
        problems.append(f"line {lines.line_num}: {error}; allowed: well-formed CSV")
    if problems:
        raise TracksError(source, problems)
    return rows


def _layout(header: list[str]) -> tuple[Layout, Callable[[list[str]], tuple[str, str, str, str]]]:
    # Movebank's web interface writes location-long, its API location_long.
    names = [name.strip().replace("_", "-") for name in header]
    for layout in LAYOUTS:
        if set(layout.columns) <= set(names):
            return layout, itemgetter(*map(names.index, layout.columns))
    found = f"the columns are {_shown(', '.join(header))}" if header else "there is no header"
    raise _BadRowError(f"{found}; allowed: {' or '.join(', '.join(layout.columns) for layout in LAYOUTS)}")


def _fix(layout: Layout, fields: tuple[str, str, str, str]) -> tuple[str, float, Place | None]:
    time, animal, east, north = map(str.strip, fields)
    time_column, animal_column, east_column, north_column = layout.columns
    if not animal:
        raise _BadRowError(f"{animal_column} is empty; allowed: any text")
    ticks = layout.ticks(time, time_column)
    if not east and not north:
        return animal, ticks, None
    east_limit, north_limit = layout.limits
    return animal, ticks, (_number(east, east_column, east_limit), _number(north, north_column, north_limit))
