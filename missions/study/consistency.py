"""Rules between the keys of a study: axes in step, figures and claims about what is varied, checks that compare."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from missions.document import Document
from missions.mission import NAME
from missions.overrides import Override
from missions.problems import Mark, Path, Problem, any_of, did_you_mean, shown
from missions.study.model import Check, Figure, Study
from missions.study.points import FAULTS, POLICY

TIME = "time"
DERIVED = ("ratio", "agents", "targets")
OVER_TIME = ("coverage", "utilization")
_SEEDS = 2**32
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.\-]{0,63}")

# What is wrong: where, what was given, what is allowed.
Broken = Iterator[tuple[Path, str, str]]


def broken_rules(document: Document, study: Study, overrides: Iterable[Override]) -> list[Problem]:
    """Every rule that the study breaks."""
    rules = (_axes(study), _names(study), _seeds(study), _figures(study), _claims(study))
    found = [Problem(document.mark(path), path, got, allowed) for rule in rules for path, got, allowed in rule]
    swept = _swept(study)
    for override in overrides:
        key = override.text.partition("=")[0].strip()
        if key in swept:
            path = tuple(key.split("."))
            found.append(Problem(Mark(override.option), path, "a key that the study sweeps", "any other key"))
    return found


def _swept(study: Study) -> dict[str, list[Any]]:
    """The values of every swept key."""
    return {key: values for axis in study.sweep for key, values in axis.items()}


def _axes(study: Study) -> Broken:
    axis_of: dict[str, int] = {}
    for number, axis in enumerate(study.sweep):
        where: Path = ("sweep", str(number))
        if not axis:
            yield where, "an axis without keys", "a mapping of keys to lists, such as {agents.count: [5, 10]}"
        first = next(iter(axis), "")
        for key, values in axis.items():
            path = (*where, key)
            if not values:
                yield path, "no values", "at least one value"
            elif len(values) != len(axis[first]):
                allowed = f"{len(axis[first])}, as many as {first} has: keys of one axis go in step"
                yield path, f"{len(values)} value{'s' if len(values) > 1 else ''}", allowed
            if key in axis_of:
                yield path, f"a second axis (the first is sweep.{axis_of[key]})", "each key on one axis"
            if key == FAULTS:
                yield path, "a list of lists of faults", "the study's faults, which have names"
            if key in (POLICY, "seed"):
                yield path, "a key that every study varies", "the study's policies, runs and seed"
            axis_of.setdefault(key, number)


def _names(study: Study) -> Broken:
    for name in study.policies:
        if not _NAME.fullmatch(name):
            yield ("policies", name), shown(name), NAME
    for name in study.faults:
        if not _NAME.fullmatch(name):
            yield (FAULTS, name), shown(name), NAME


def _seeds(study: Study) -> Broken:
    if study.seed + study.runs > _SEEDS:
        yield ("seed",), shown(study.seed), f"at most {_SEEDS - study.runs}, so that the last run has a seed"


def _figures(study: Study) -> Broken:
    axes = (TIME, *DERIVED, *_swept(study))
    names: set[str] = set()
    for number, figure in enumerate(study.figures):
        path: Path = ("figures", str(number))
        if figure.name in names:
            yield (*path, "name"), shown(figure.name), "a name that no other figure has"
        names.add(figure.name)
        if figure.x not in axes:
            yield (*path, "x"), shown(figure.x), any_of(axes) + did_you_mean(figure.x, axes)
        elif not all(_is_number(value) for value in _swept(study).get(figure.x, [])):
            yield (*path, "x"), f"{shown(figure.x)}, whose values are no numbers", "a key swept over numbers"
        yield from _over_time(figure, path)
        yield from _where(study, figure.where, (*path, "where"))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _over_time(figure: Figure, path: Path) -> Broken:
    if figure.x == TIME and figure.y not in OVER_TIME:
        yield (*path, "y"), shown(figure.y), f"{any_of(OVER_TIME)} where x is time"


def _claims(study: Study) -> Broken:
    for number, claim in enumerate(study.claims):
        for place, check in enumerate(claim.checks):
            path: Path = ("claims", str(number), "checks", str(place))
            yield from _where(study, check.of, (*path, "of"))
            yield from _where(study, check.than or {}, (*path, "than"))
            yield from _compares(check, path)


def _compares(check: Check, path: Path) -> Broken:
    other = (check.than, check.than_metric, check.than_from_s, check.than_until_s)
    compared = any(part is not None for part in other)
    if compared == (check.value is not None):
        got = "two things to compare with" if compared else "nothing to compare with"
        yield path, got, "either value, or some of than, than_metric, than_from_s and than_until_s"
    if check.expect == "closer" and (check.than is None or check.than_until_s is None):
        yield path, "closer without than or its window", "than, than_from_s and than_until_s with closer"
    for key in ("", "than_"):
        start, end = getattr(check, f"{key}from_s"), getattr(check, f"{key}until_s")
        if start is not None and end is not None and end <= start:
            yield (*path, f"{key}until_s"), shown(end), f"more than {key}from_s ({shown(start)})"


def _where(study: Study, where: Mapping[str, Any], path: Path) -> Broken:
    known: dict[str, list[Any] | None] = {**_swept(study), **dict.fromkeys(DERIVED)}
    known[POLICY] = list(study.policies) or None
    if study.faults:
        known[FAULTS] = list(study.faults)
    for key, wanted in where.items():
        if key not in known:
            yield (*path, key), "a key that is not varied", any_of(known) + did_you_mean(key, known)
            continue
        values = known[key]
        for value in wanted if isinstance(wanted, list) else [wanted]:
            if values is not None and value not in values:
                yield (*path, key), shown(value), any_of(map(shown, values))
