"""Values put on top of a mission: `--set agents.count=5` puts 5, read as YAML, at that key of the document."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from missions.document import Document, read_value
from missions.problems import Mark, MissionError, Path, Problem, shown

_FORM = "KEY=VALUE, such as agents.count=5"


@dataclass(frozen=True, slots=True)
class Override:
    """One `KEY=VALUE`, and the option it was given with, which names it in problems."""

    text: str
    option: str = "--set"


@dataclass(frozen=True, slots=True)
class Setting:
    """A value for one key that needs no reading, and where it was given."""

    path: Path
    value: Any
    mark: Mark


def apply_override(document: Document, override: Override | Setting) -> None:
    """Put the value into the document; a later one wins. What is wrong becomes the document's problem.

    Whether there is such a key, and whether the value is allowed, shows when the whole document is checked.
    """
    if isinstance(override, Setting):
        document.put(override.path, override.value, override.mark)
        return
    mark = Mark(override.option)
    key, equals, text = override.text.partition("=")
    path: Path = tuple(key.strip().split("."))
    if not equals or not all(path):
        document.problems.append(Problem(mark, (), shown(override.text), _FORM))
        return
    try:
        value = read_value(document, path, text, mark=mark)
    except MissionError as error:
        document.problems += [Problem(mark, path, problem.got, problem.allowed) for problem in error.problems]
        return
    document.put(path, value, mark)
