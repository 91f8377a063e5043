"""Conditions for scripts: `coverage > .9 and help.calls < 30`, over the numbers of a report.

    condition ::= comparison { "and" comparison }
    comparison ::= term OP term          OP: < <= > >= == !=
    term ::= number | 90% | a name of the report, such as coverage or radio.lost

Nothing is evaluated but this. A number that the report does not have (no coverage, since the mission never began)
fulfills no comparison.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from missions.problems import InputError, any_of, did_you_mean, shown
from missions.report import Report

_OF_THE_FLIGHT = frozenset({"timing.wall_s", "timing.realtime_factor"})

Numbers = Mapping[str, float | None]

_OPERATORS: dict[str, Callable[[float, float], bool]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
}
_TOKEN = re.compile(
    r"\s*(?:(?P<number>[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:e[+-]?\d+)?)(?P<percent>\s*%)?"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_.]*)|(?P<operator><=|>=|==|!=|<|>))",
    re.IGNORECASE,
)


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether a condition holds, and the numbers it was about."""

    condition: str
    holds: bool
    found: Numbers

    def __str__(self) -> str:
        found = ", ".join(
            f"{name} = {'none' if number is None else f'{number:g}'}" for name, number in self.found.items()
        )
        return f"{'holds' if self.holds else 'FAILS'}: {self.condition}" + (f"   ({found})" if found else "")


def numbers_of(report: Report) -> dict[str, float | None]:
    """Every number of a report by its dotted name; `faults` is how many there are."""
    found: dict[str, float | None] = {}
    for key, value in report.items():
        if isinstance(value, Mapping):
            found |= {f"{key}.{name}": number for name, number in numbers_of(dict(value)).items()}
        elif isinstance(value, list):
            found[key] = len(value)
        elif value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)):
            found[key] = value
    return found


def countable(report: Report) -> dict[str, float | None]:
    """The numbers that a recording tells: how long a flight took on the wall clock is not among them."""
    return {name: number for name, number in numbers_of(report).items() if name not in _OF_THE_FLIGHT}


def judge(condition: str, numbers: Numbers) -> Verdict:
    """Whether the condition holds.

    Raises:
        InputError: it is none, or names a number that there is not; the text says what is allowed.
    """
    found: dict[str, float | None] = {}
    holds = True
    for words in _comparisons(condition):
        if len(words) != 3 or words[1] not in _OPERATORS:
            raise _bad(condition, f"comparisons such as coverage > .9 with {any_of(_OPERATORS)}, joined by and")
        low, high = (_value(word, numbers, found) for word in (words[0], words[2]))
        holds = holds and low is not None and high is not None and _OPERATORS[words[1]](low, high)
    return Verdict(condition, holds, found)


def _comparisons(condition: str) -> list[list[str]]:
    comparisons: list[list[str]] = [[]]
    for word in _words(condition):
        if word.lower() == "and":
            comparisons.append([])
        else:
            comparisons[-1].append(word)
    return comparisons


def _words(condition: str) -> list[str]:
    words, position = [], 0
    text = condition.rstrip()
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise _bad(condition, f"a number, a name or {any_of(_OPERATORS)} at {text[position:].strip()[:20]!r}")
        number, percent = match["number"], match["percent"]
        words.append(str(float(number) / 100) if number and percent else match[0].strip())
        position = match.end()
    return words


def _value(word: str, numbers: Numbers, found: dict[str, float | None]) -> float | None:
    if not (word[0].isalpha() or word[0] == "_"):  # a name, though it be nan or inf
        return float(word)
    if word not in numbers:
        raise _bad(word, f"{any_of(numbers)}{did_you_mean(word, numbers)}")
    found[word] = numbers[word]
    return numbers[word]


def _bad(given: str, allowed: str) -> InputError:
    return InputError(f"--check: got {shown(given)}; allowed: {allowed}")
