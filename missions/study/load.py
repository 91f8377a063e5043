"""Study files to studies that can be flown: every mistake is found at once, and named with its line and key.

ready = load_study("figure-16")  # a bundled study, or a path
ready = load_study("my.yaml", runs=20, policies=["b-cmommt-basic"], overrides=[Override("duration_s=60")])
text = dump_study(ready)  # YAML with every key of the mission; loads to the same points
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path as FilePath
from typing import Any, get_args

from ruamel.yaml import YAML

from missions.document import Document, read_document
from missions.load import (
    LIBRARY,
    checked_mission,
    in_file_order,
    key_problem,
    open_mission,
    override_mission,
    read_input,
    validated,
)
from missions.mission import Mission, Policy
from missions.overrides import Override, Setting
from missions.problems import InputError, Mark, MissionError, Path, Problem, any_of
from missions.study.consistency import broken_rules
from missions.study.model import Study
from missions.study.pairs import NoOnePartnerError, pairs
from missions.study.points import FAULTS, POLICY, Labels, Point, combinations

STUDIES = LIBRARY / "studies"


@dataclass(frozen=True, slots=True)
class ReadyStudy:
    """A study that can be flown: as written but for what the command line changed, with the missions it comes to.

    Attributes:
        study: what the file says. base: the mission before anything is varied. points: all that is flown.
    """

    study: Study
    base: Mission
    points: tuple[Point, ...]

    @property
    def seeds(self) -> range:
        """The seeds of every point."""
        return range(self.study.seed, self.study.seed + self.study.runs)


def bundled_studies() -> list[str]:
    """The studies that come with the package, in alphabetical order."""
    return sorted(path.stem for path in STUDIES.glob("*.yaml"))


def load_study(
    name_or_path: str,
    *,
    runs: int | None = None,
    seed: int | None = None,
    policies: Sequence[str] = (),
    overrides: Sequence[Override] = (),
) -> ReadyStudy:
    """The study in a file, or the bundled one of that name.

    Args:
        runs, seed: other ones than the file's. overrides: values for the mission, on top of the study's `set`.
        policies: fly these alone: names the study has for its policies, or policies as missions know them.

    Raises:
        MissionError: no such study, or mistakes in it, in its mission or in the overrides: all of them.
        InputError: no such policy.
    """
    bundled = name_or_path in bundled_studies()
    path = STUDIES / f"{name_or_path}.yaml" if bundled else FilePath(name_or_path)
    source = path.name if bundled else name_or_path
    data = read_input(path, source=source, what="study", bundled=bundled_studies())
    document = read_document(data, source=source)
    for key, mine in (("runs", runs), ("seed", seed)):
        if mine is not None:
            document.put((key,), mine, Mark(f"--{key}"))
    study = _checked_study(document, overrides)
    study = study.model_copy(update={"policies": _chosen(study, policies)})
    return _Maker(study, document, path.parent, overrides).ready()


def dump_study(ready: ReadyStudy) -> str:
    """The study as YAML with all of its mission written out, so that it stays the same when defaults change."""
    base = ready.base.model_dump(mode="json")
    told = ready.study.model_dump(mode="json", exclude_unset=True)
    whole = {**told, "mission": "reference", "set": base, "runs": ready.study.runs, "seed": ready.study.seed}
    order = [key for key in Study.model_fields if key in whole]
    out = StringIO()
    yaml = YAML()
    yaml.width = 120
    yaml.dump({key: whole[key] for key in order}, out)
    return out.getvalue()


def _checked_study(document: Document, overrides: Iterable[Override]) -> Study:
    study, errors = validated(Study, document.values)
    unread = {problem.path for problem in document.problems}
    found = [key_problem(document, error, Study) for error in errors]
    problems = document.problems + [p for p in found if p.path not in unread or p.got != "null"]
    if study is not None:
        problems += broken_rules(document, study, overrides)
    if study is None or problems:
        raise MissionError(sorted(problems, key=lambda problem: in_file_order(problem, document.source)))
    return study


def _chosen(study: Study, policies: Sequence[str]) -> dict[str, dict[str, Any]]:
    if not policies:
        return study.policies
    known = get_args(Policy.model_fields["name"].annotation)
    chosen: dict[str, dict[str, Any]] = {}
    for name in policies:
        if name in study.policies:
            chosen[name] = study.policies[name]
        elif name in known:
            chosen[name] = {"name": name}
        else:
            words = any_of(dict.fromkeys((*study.policies, *known)))
            raise InputError(str(Problem(Mark("--policy"), (), f'"{name}"', words)))
    return chosen


class _Maker:
    """Makes the missions of a study, and gathers what is wrong with them; values are blamed on the study's lines."""

    def __init__(self, study: Study, document: Document, folder: FilePath, overrides: Sequence[Override]) -> None:
        self._study = study
        self._document = document
        self._folder = folder
        self._overrides = overrides
        self._problems: dict[str, Problem] = {}  # by text: points share their mistakes

    def ready(self) -> ReadyStudy:
        mission = self._open()
        base = self._made(mission, ())
        points = []
        for number, labels in enumerate(combinations(self._study, self._policies(mission))):
            made = self._made(mission, labels)
            if made is not None:
                points.append(Point(number, labels, made))
        if not self._problems:
            self._check_claims(points)
        if self._problems or base is None:
            source = self._document.source
            raise MissionError(sorted(self._problems.values(), key=lambda problem: in_file_order(problem, source)))
        return ReadyStudy(self._study, base, tuple(points))

    def _open(self) -> Document:
        try:
            mission = open_mission(self._study.mission, folder=self._folder)
        except MissionError as error:
            first = error.problems[0]
            if first.got.startswith("no such"):  # the line of the study that asks for it is what to look at
                path: Path = ("mission",)
                raise MissionError([Problem(self._document.mark(path), path, first.got, first.allowed)]) from error
            raise
        settings = [self._setting(("set", key), key, value) for key, value in self._study.set.items()]
        override_mission(mission, settings, folder=self._folder)
        override_mission(mission, self._overrides)
        return mission

    def _policies(self, mission: Document) -> list[str]:
        own = mission.value(("policy", "name")) or Policy.model_fields["name"].default
        return list(self._study.policies) or [str(own)]

    def _made(self, mission: Document, labels: Labels) -> Mission | None:
        own = mission.copy()
        override_mission(own, self._settings(labels), folder=self._folder)
        try:
            return checked_mission(own, for_study=True)
        except MissionError as error:
            self._problems |= {str(problem): problem for problem in error.problems}
            return None

    def _check_claims(self, points: Sequence[Point]) -> None:
        for number, claim in enumerate(self._study.claims):
            for place, check in enumerate(claim.checks):
                path: Path = ("claims", str(number), "checks", str(place), "than")
                try:
                    list(pairs(self._study, points, check))
                except NoOnePartnerError as error:
                    problem = Problem(self._document.mark(path), path, str(error), "what fits one point")
                    self._problems[str(problem)] = problem

    def _settings(self, labels: Labels) -> list[Setting]:
        axis_of = {key: str(number) for number, axis in enumerate(self._study.sweep) for key in axis}
        settings = [
            self._setting(("sweep", axis_of[key], key), key, value)
            for key, value in labels
            if key not in (POLICY, FAULTS)
        ]
        told = dict(labels)
        if FAULTS in told:
            name = str(told[FAULTS])
            settings.append(self._setting((FAULTS, name), FAULTS, self._study.faults[name]))
        policy = told.get(POLICY)
        for key, value in self._study.policies.get(str(policy), {}).items():
            settings.append(self._setting(("policies", str(policy), key), f"{POLICY}.{key}", value))
        return settings

    def _setting(self, where: Path, key: str, value: Any) -> Setting:
        return Setting(tuple(key.split(".")), value, self._document.mark(where))
