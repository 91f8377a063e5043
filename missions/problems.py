"""What is wrong with a mission file, one line each: where, which key, what was given, what is allowed."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

Path = tuple[str, ...]
"""A key's place in a mission: ("agents", "sensing", "range_m")."""

_LONGEST_SHOWN = 60


@dataclass(frozen=True, slots=True)
class Mark:
    """Where a value was given: a file and its line (from 1), or an option such as `--set`."""

    source: str
    line: int | None = None

    def __str__(self) -> str:
        return self.source if self.line is None else f"{self.source}:{self.line}"


@dataclass(frozen=True, slots=True)
class Problem:
    """One mistake; as text `quickstart.yaml:12: agents.sensing.range_m: got -3; allowed: a number above 0`."""

    mark: Mark
    path: Path
    got: str
    allowed: str

    def __str__(self) -> str:
        where = f"{self.mark}: {dotted(self.path)}" if self.path else str(self.mark)
        return f"{where}: got {self.got}; allowed: {self.allowed}"


class InputError(ValueError):
    """What the user gave cannot be used; the error's text is what to tell them. Exit code 2."""


class OutputError(RuntimeError):
    """What was to be kept of a mission cannot be written; the mission itself is none the worse."""


class MissionError(InputError):
    """A mission that cannot be flown; `problems` holds every mistake found, in the order of the file's lines."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        super().__init__(problems)
        self.problems = tuple(problems)

    def __str__(self) -> str:
        return "\n".join(map(str, self.problems))


def dotted(path: Path) -> str:
    """The path as a user writes it after `--set`."""
    return ".".join(key if key.isprintable() and len(key) <= _LONGEST_SHOWN else shown(key) for key in path)


def shown(value: Any) -> str:
    """A value as YAML would have it, on one line and not too long."""
    if isinstance(value, Mapping):
        return "a mapping"
    if isinstance(value, list):
        return "a list"
    if isinstance(value, float):
        return f"{value:.12g}"
    text = json.dumps(value, ensure_ascii=not str(value).isprintable())
    return text if len(text) <= _LONGEST_SHOWN else text[: _LONGEST_SHOWN - 3] + "..."


def any_of(words: Iterable[str]) -> str:
    """ "a, b or c"."""
    *most, last = words
    return f"{', '.join(most)} or {last}" if most else last


def did_you_mean(word: str, known: Iterable[str], *, at_most: int = 1) -> str:
    """An ending for `allowed` that names the known words nearest to `word`; empty when none is near."""
    near = get_close_matches(word, list(known), n=at_most)
    return f"; did you mean {any_of(near)}?" if near else ""
