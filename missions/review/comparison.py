"""Two missions side by side: what was set differently, what came out differently, and when they parted."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from comms.status import Activity
from missions.colors import ACTIVITY_INKS, hex_color
from missions.review.checks import numbers_of
from missions.review.reading import Review
from missions.review.words import clock, percent

# Whether more of it is better; of the rest nobody can say.
_BETTER: Mapping[str, bool] = {
    "coverage": True,
    "coverage_late": True,
    "utilization": True,
    "events.target_loss": False,
    "faults": False,
    "radio.lost": False,
    "mavlink.bad": False,
    "mavlink.dropped": False,
    "timing.tick_late_s_max": False,
}
_SHARES = frozenset({"coverage", "coverage_late", "coverage_floor"})
# What a mission is called changes nothing: it comes last.
_LABELS = frozenset({"name", "description"})
_ALWAYS = ("coverage", "events.target_loss", "help.calls")
_GOOD, _BAD = (hex_color(ACTIVITY_INKS[activity]) for activity in (Activity.FOLLOW, Activity.LOST))


@dataclass(frozen=True, slots=True)
class Difference:
    """A setting or a number that differs; `gain` is above 0 where the second mission did better, None if unknown."""

    name: str
    first: str
    second: str
    change: str = ""
    gain: float | None = None


def setting_differences(first: Mapping[str, Any], second: Mapping[str, Any]) -> list[Difference]:
    """Keys of the two mission files that differ, `a.b.c`."""
    flat_first, flat_second = dict(_flat(first)), dict(_flat(second))
    return [
        Difference(key, _said(flat_first, key), _said(flat_second, key))
        for key in sorted(flat_first.keys() | flat_second.keys(), key=lambda key: (key in _LABELS, key))
        if flat_first.get(key, _MISSING) != flat_second.get(key, _MISSING)
    ]


def number_differences(first: Review, second: Review) -> list[Difference]:
    """Numbers of the two reports that differ, and those that everybody asks for."""
    numbers, others = numbers_of(first.report), numbers_of(second.report)
    names = [name for name in numbers if name in _ALWAYS or numbers[name] != others.get(name)]
    return [_difference(name, numbers[name], others.get(name)) for name in names if name != "seed"]


def parting_s(first: Review, second: Review) -> float | None:
    """Mission clock of the first tick in which an agent does, follows or helps otherwise; None: never."""
    deeds = (review.series.deeds for review in (first, second))
    return next((time_s for time_s, deed, other in _pairs(first, second, *deeds) if deed != other), None)


def _pairs(
    first: Review, second: Review, prints: Sequence[int], others: Sequence[int]
) -> Iterator[tuple[float, int, int]]:
    """Time and prints of the ticks that both have, by the mission clock."""
    by_time = {round(time_s, 6): other for time_s, other in zip(second.series.time_s, others, strict=True)}
    for time_s, mine in zip(first.series.time_s, prints, strict=True):
        other = by_time.get(round(time_s, 6))
        if other is not None:
            yield time_s, mine, other


def _opening(first: Review, second: Review) -> str:
    """How much alike they are, in a sentence."""
    parted_s = parting_s(first, second)
    if parted_s is not None:
        return f"The two missions part at {clock(parted_s)}."
    if len(first.series.time_s) != len(second.series.time_s):
        return "The two missions are the same as far as both are recorded."
    places = (review.series.places for review in (first, second))
    if all(mine == other for _, mine, other in _pairs(first, second, *places)):
        return "The two missions are the same, tick by tick."
    return "Everybody does the same in both missions, at other places."


def print_comparison(first: Review, second: Review, console: Console) -> None:
    """Print what differs."""
    console.print(Group(*_parts(first, second)))


_MISSING = object()


def _parts(first: Review, second: Review) -> Iterator[RenderableType]:
    names = first.playback.path.name, second.playback.path.name
    settings = setting_differences(first.settings, second.settings)
    numbers = number_differences(first, second)
    yield Text(_opening(first, second), "bold")
    if settings:
        yield Text()
        yield _table("Settings that differ", names, settings)
    yield Text()
    yield _table("What came of it", names, numbers)


def _table(title: str, names: Sequence[str], rows: Sequence[Difference]) -> Table:
    table = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False)
    table.add_column("")
    for name in names:
        table.add_column(name, justify="right")
    changes = any(row.change for row in rows)
    if changes:
        table.add_column("change", justify="right")
    for row in rows:
        color = "" if not row.gain else _GOOD if row.gain > 0 else _BAD
        # What nobody can call better or worse stands back.
        style = "dim" if row.change and row.gain is None and row.name not in _ALWAYS else ""
        change = [Text(row.change, color)] if changes else []
        table.add_row(row.name, row.first, row.second, *change, style=style)
    return table


def _difference(name: str, first: float | None, second: float | None) -> Difference:
    words = percent if name in _SHARES else _number
    if first is None or second is None or first == second:
        return Difference(name, words(first), words(second))
    change = second - first
    if name in _SHARES:
        told = f"{100 * change:+.1f} points"
    else:
        told = f"{change:+.3g}" if isinstance(change, float) else f"{change:+}"
    gain = None if name not in _BETTER else change if _BETTER[name] else -change
    return Difference(name, words(first), words(second), told, gain)


def _number(number: float | None) -> str:
    return "–" if number is None else f"{number:.6g}" if isinstance(number, float) else str(number)


def _flat(settings: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(settings, Mapping):
        for key, value in settings.items():
            yield from _flat(value, f"{path}.{key}" if path else str(key))
    else:
        yield path, settings


def _said(settings: Mapping[str, Any], key: str) -> str:
    value = settings.get(key, "–")
    if isinstance(value, list) and value and all(isinstance(part, Mapping) and "kind" in part for part in value):
        return f"{len(value)}: {', '.join(str(part['kind']) for part in value)}"
    return str(value)
