"""The points of a study: every combination of what is varied, each with its mission."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

from missions.mission import Mission, MovingTargets
from missions.study.model import Study

POLICY, FAULTS = "policy", "faults"
Labels = tuple[tuple[str, Any], ...]
"""What tells a point from the others: the swept keys with their values, then `faults` and `policy` with their names."""


@dataclass(frozen=True, slots=True)
class Point:
    """One mission of a study, flown once for every seed. `number` counts from 0 in the order of the study."""

    number: int
    labels: Labels
    mission: Mission

    @property
    def values(self) -> dict[str, Any]:
        """What may stand on an axis, in a claim or in a table: the labels, and what follows from the mission."""
        targets, m = self.mission.targets, self.mission.agents.count
        counts: dict[str, Any] = {"agents": m}
        if isinstance(targets, MovingTargets):
            counts |= {"targets": targets.count, "ratio": targets.count / m}
        return {**counts, **dict(self.labels)}

    @property
    def digest(self) -> str:
        """Names all that decides how the point's missions go, but their seeds: 16 hexadecimal digits."""
        told = self.mission.model_dump(mode="json", exclude={"name", "description", "seed"})
        return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()[:16]


def combinations(study: Study, policies: Iterable[str]) -> Iterator[Labels]:
    """Every combination of one place on each axis, some faults and one policy, the first axis turning slowest."""
    axes = [_places(axis) for axis in study.sweep]
    if study.faults:
        axes.append([((FAULTS, name),) for name in study.faults])
    for places in product(*axes, [((POLICY, policy),) for policy in policies]):
        yield tuple(label for place in places for label in place)


def matches(point: Point, where: Mapping[str, Any]) -> bool:
    """Whether a point has the values asked for; a list asks for one of its values."""
    values = point.values
    return all(values.get(key) in (wanted if isinstance(wanted, list) else [wanted]) for key, wanted in where.items())


def labels_but(point: Point, key: str) -> Labels:
    """The labels of a point without one of them."""
    return tuple(label for label in point.labels if label[0] != key)


def varied(points: Iterable[Point]) -> list[str]:
    """The labels in which the points differ."""
    found: dict[str, list[Any]] = {}
    for point in points:
        for key, value in point.labels:
            seen = found.setdefault(key, [])
            if value not in seen:
                seen.append(value)
    return [key for key, seen in found.items() if len(seen) > 1]


def _places(axis: Mapping[str, list[Any]]) -> list[Labels]:
    """An axis place by place; its keys go in step."""
    count = max((len(values) for values in axis.values()), default=0)
    return [tuple((key, values[place]) for key, values in axis.items()) for place in range(count)]
