"""What is varied, in words for legends, axes and tables: `agents.deployment.radius_m` 5 is "radius 5 m"."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from missions.problems import shown
from missions.study.points import FAULTS, POLICY, Point, varied

_UNITS = {
    "_m_s2": "m/s²",
    "_m_s": "m/s",
    "_per_s": "1/s",
    "_mah": "mAh",
    "_deg": "°",
    "_m": "m",
    "_s": "s",
    "_v": "V",
    "_a": "A",
}
_COUNTED = {"agents.count": "agents", "targets.count": "targets"}
_AXES = {
    "time": "time (s)",
    "ratio": "targets per agent",
    "agents": "agents",
    "targets": "targets",
    **_COUNTED,
}


def axis_words(key: str) -> str:
    """What stands at an axis: "speed (m/s)"."""
    if key in _AXES:
        return _AXES[key]
    name, unit = _split(key)
    return f"{name} ({unit})" if unit else name


def value_words(key: str, value: Any) -> str:
    """One value of what is varied: "10 agents", "radius 5 m", "b-cmommt"."""
    if key in (POLICY, FAULTS):
        return str(value)
    if key in _COUNTED:
        return f"{value} {_COUNTED[key] if value != 1 else _COUNTED[key][:-1]}"
    name, unit = _split(key)
    text = value if isinstance(value, str) else shown(value)
    return f"{name} {text} {unit}".rstrip()


def point_words(point: Point, keys: Iterable[str]) -> str:
    """A point by some of its labels, each said once: "10 agents, radius 5 m, basic"."""
    labels = dict(point.labels)
    said = dict.fromkeys(value_words(key, labels[key]) for key in keys if key in labels)
    return ", ".join(said)


def telling_keys(points: Sequence[Point], *, but: str = "") -> list[str]:
    """The labels in which points differ, without `but` and what always goes in step with it."""
    keys = varied(points)
    if but == "time" or not but:
        return keys
    of = [point.values.get(but) for point in points]
    if but == "ratio":
        return [key for key in keys if key != "targets.count"]
    return [key for key in keys if key != but and not _in_step(of, [dict(point.labels).get(key) for point in points])]


def _in_step(one: Sequence[Any], other: Sequence[Any]) -> bool:
    """Whether either value follows from the other."""
    pairs = list(zip(map(repr, one), map(repr, other), strict=True))
    return len(set(pairs)) == len({a for a, _ in pairs}) == len({b for _, b in pairs})


def _split(key: str) -> tuple[str, str]:
    """The last word of a key without its unit, and the unit."""
    last = key.rsplit(".", 1)[-1]
    for ending, unit in _UNITS.items():
        if last.endswith(ending):
            return last.removesuffix(ending).replace("_", " "), unit
    return last.replace("_", " "), ""
