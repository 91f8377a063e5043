"""Mission files to missions: every mistake of a file is found at once, and named with its line and key.

mission = load_mission("quickstart")  # a bundled mission, or a path
mission = load_mission("my.yaml", overrides=[Override("agents.count=5")])
text = dump_mission(mission)  # YAML with every key; loads to the same mission
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from copy import deepcopy
from difflib import get_close_matches
from io import StringIO
from pathlib import Path as FilePath
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails
from ruamel.yaml import YAML

from missions.document import Document, read_document, step
from missions.faults.consistency import fault_rules
from missions.keys import Key, allowed, allowed_list, chooser, find_key, is_list
from missions.mission import Mission, Part
from missions.overrides import Override, Setting, apply_override
from missions.problems import Mark, MissionError, Path, Problem, did_you_mean, shown
from missions.rules import FLIGHT_RULES, RULES, STUDY_RULES, Rule

LIBRARY = FilePath(__file__).parent / "library"

P = TypeVar("P", bound=Part)

NO_LIST = ("tuple_type", "too_long", "too_short")
"""What pydantic calls it where a whole list is wrong, and not a part of it."""
_MAX_BYTES = 1_000_000
_FILES: tuple[Path, ...] = (("targets", "file"), ("policy", "weights"), ("vehicle", "signing_key"))


def bundled_names() -> list[str]:
    """The missions that come with the package, in alphabetical order."""
    return sorted(path.stem for path in LIBRARY.glob("*.yaml"))


def load_mission(name_or_path: str, *, overrides: Iterable[Override] = (), for_study: bool = False) -> Mission:
    """The mission in a file, or the bundled one of that name, with `overrides` put on top.

    Args:
        for_study: whether it may have what only a study has (foresight, a referee), and cannot be flown.

    Raises:
        MissionError: no such mission, or mistakes in it or in the overrides: all of them.
    """
    document = open_mission(name_or_path)
    override_mission(document, overrides)
    return checked_mission(document, for_study=for_study)


def parse_mission(data: bytes, *, source: str, folder: FilePath, overrides: Iterable[Override] = ()) -> Mission:
    """`load_mission` of a file's bytes. `source` names it in problems; its relative paths start at `folder`."""
    document = read_document(data, source=source)
    _anchor(document, folder)
    override_mission(document, overrides)
    return checked_mission(document)


def open_mission(name_or_path: str, *, folder: FilePath | None = None) -> Document:
    """The document of `load_mission`, its keys not yet checked; a relative path starts at `folder`, or else here."""
    bundled = name_or_path in bundled_names()
    path = LIBRARY / f"{name_or_path}.yaml" if bundled else (folder or FilePath()) / name_or_path
    source = path.name if bundled else name_or_path
    document = read_document(read_input(path, source=source, what="mission", bundled=bundled_names()), source=source)
    _anchor(document, path.parent)
    return document


def override_mission(
    document: Document, overrides: Iterable[Override | Setting], *, folder: FilePath | None = None
) -> None:
    """Put values into an open mission; their relative paths start at `folder`, or else at the working directory."""
    for override in overrides:
        apply_override(document, override)
    _anchor(document, folder or FilePath.cwd())


def checked_mission(document: Document, *, for_study: bool = False) -> Mission:
    """The mission of an open document; `for_study` as in `load_mission`.

    Raises:
        MissionError: all mistakes in it, in the order of its lines.
    """
    mission, problems = _check(document, RULES + (STUDY_RULES if for_study else FLIGHT_RULES))
    problems = sorted([*document.problems, *problems], key=lambda problem: in_file_order(problem, document.source))
    if mission is None or problems:
        raise MissionError(problems)
    return mission


def dump_mission(mission: Mission) -> str:
    """The whole mission as YAML, defaults written out."""
    out = StringIO()
    yaml = YAML()
    yaml.width = 120
    yaml.dump(mission.model_dump(mode="json"), out)
    return out.getvalue()


def read_input(path: FilePath, *, source: str, what: str, bundled: Sequence[str]) -> bytes:
    """The bytes of a mission or study file; `what` and the `bundled` ones are for the words of the error.

    Raises:
        MissionError: there is no such file, or it cannot be read.
    """
    a_file = f"the path of a {what} file"
    try:
        with path.open("rb") as file:
            data = file.read(_MAX_BYTES + 1)
    except FileNotFoundError as error:
        hint = did_you_mean(path.stem, bundled, at_most=3)
        choices = f"{a_file}, or a bundled {what} ({', '.join(bundled)}){hint}"
        raise MissionError([Problem(Mark(source), (), f"no such {what}", choices)]) from error
    except (OSError, ValueError) as error:
        got = "a directory" if isinstance(error, IsADirectoryError) else f"an unreadable file ({error})"
        raise MissionError([Problem(Mark(source), (), got, a_file)]) from error
    if len(data) > _MAX_BYTES:
        raise MissionError([Problem(Mark(source), (), "more than a megabyte", a_file)])
    return data


def _anchor(document: Document, folder: FilePath) -> None:
    """Make relative paths absolute: from here on they mean the same wherever the mission is used."""
    for section, key in _FILES:
        file = document.value((section, key))
        if isinstance(file, str) and file:
            if file.startswith("~/"):
                file = os.path.expanduser(file)
            document.values[section][key] = str((folder / file).absolute())


def _check(document: Document, rules: Sequence[Rule]) -> tuple[Mission | None, list[Problem]]:
    """The mission, None if a key is wrong; and the problems of single keys and of the rules between them."""
    unread = {problem.path for problem in document.problems}
    mission, errors = validated(Mission, document.values)
    found = [key_problem(document, error) for error in errors]
    # What could not be read stands as null, which is not a second mistake.
    found = [problem for problem in found if problem.path not in unread or problem.got != "null"]
    wrong = unread | {path for error in errors for path in _in_doubt(find_key(error["loc"]))}
    return mission, found + _broken_rules(document, mission or _mended(document, wrong), wrong, rules)


def validated(root: type[P], values: dict[str, Any]) -> tuple[P | None, list[ErrorDetails]]:
    """The values as the model has them; None if a key is wrong, and then what pydantic says."""
    try:
        return root.model_validate(values), []
    except ValidationError as error:
        return None, error.errors(include_url=False, include_context=False)


def key_problem(document: Document, error: ErrorDetails, root: type[Part] = Mission) -> Problem:
    """One of pydantic's errors about the values of `document`, in our words."""
    key = find_key(error["loc"], root)
    mark = document.mark(key.path)
    if key.field is None:
        known = list(key.section.model_fields)
        return Problem(mark, key.path, "an unknown key", ", ".join(known) + did_you_mean(key.path[-1], known))
    if error["type"] in NO_LIST and is_list(key.field):
        return Problem(mark, key.path, shown(error["input"]), allowed_list(key.field))
    chosen = chooser(key.field)
    if chosen is not None and isinstance(error["input"], dict):
        path = (*key.path, chosen[0])
        got = shown(document.value(path)) if chosen[0] in error["input"] else "nothing"
        return Problem(document.mark(path), path, got, chosen[1])
    got = "nothing" if error["type"] == "missing" else shown(error["input"])
    return Problem(mark, key.path, got, allowed(key.field))


def _in_doubt(key: Key) -> list[Path]:
    """The keys whose values are not known because `key` is wrong: an unknown key may be any beside it, misspelled."""
    if key.field is not None:
        return [key.path]
    if len(key.path) > 1:
        return [key.path, key.path[:-1]]
    return [key.path, *((near,) for near in get_close_matches(key.path[0], Mission.model_fields))]


def _mended(document: Document, wrong: set[Path]) -> Mission | None:
    """The mission with default values where keys are wrong, so that the rules between the others can be checked."""
    values = deepcopy(document.values)
    for path in wrong:
        section: Any = values
        for name in path[:-1]:
            section = section.get(name) if isinstance(section, dict) else None
        if path and isinstance(section, dict):
            section.pop(path[-1], None)
    values.setdefault("name", "unnamed")
    mission, errors = validated(Mission, values)
    if mission is None:  # a key that has no default went: its whole section has to
        for error in errors:
            wrong.add((str(error["loc"][0]),))
            values.pop(str(error["loc"][0]), None)
        mission, _ = validated(Mission, values)
    return mission


def _broken_rules(
    document: Document, mission: Mission | None, wrong: set[Path], rules: Sequence[Rule]
) -> list[Problem]:
    if mission is None:
        return []
    checkable = [
        rule
        for rule in (*rules, *fault_rules(mission))
        if not any(path[:n] in wrong for path in rule.paths for n in range(1, 9))
    ]
    broken = [(rule, rule.allowed(mission)) for rule in checkable]
    return [_rule_problem(document, mission, rule, text) for rule, text in broken if text is not None]


def _rule_problem(document: Document, mission: Mission, rule: Rule, text: str) -> Problem:
    blamed = rule.paths[0]
    value: Any = mission.model_dump(mode="json")
    for name in blamed:
        value = step(value, name)
    if blamed in document.marks:
        return Problem(document.marks[blamed], blamed, shown(value), text)
    # A default is at odds with what was given elsewhere: that is the line to look at.
    given = next((path for path in rule.paths if path in document.marks), ())
    return Problem(document.mark(given), blamed, f"{shown(value)} (the default)", text)


def in_file_order(problem: Problem, source: str) -> tuple[bool, int]:
    """Sorts problems: those of the file first, by line."""
    return problem.mark.source != source, problem.mark.line or 0
