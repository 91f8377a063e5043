"""Which points a claim compares: each point that a check is of, and its partner."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from missions.study.model import Check, Claim, Study
from missions.study.points import FAULTS, POLICY, Point, matches

# What a derived value is made of: naming it leaves these open.
_MADE_OF = {
    "agents": {"agents.count"},
    "targets": {"targets.count"},
    "ratio": {"agents.count", "targets.count"},
}


class NoOnePartnerError(ValueError):
    """A check whose `than` fits no point, or several; the text says how many."""


def compares_policies(claim: Claim) -> bool:
    """Whether a claim is about certain policies, and not about any one by itself."""
    return any(POLICY in (check.than or {}) or POLICY in check.of for check in claim.checks)


def pairs(study: Study, points: Sequence[Point], check: Check) -> Iterator[tuple[Point, Point]]:
    """Every point the check is of, and the point it is compared with: itself where `than` is not given.

    Raises:
        NoOnePartnerError: `than` fits no point or several, although all of the study's policies are there.
    """
    for point in points:
        if not matches(point, check.of):
            continue
        if check.than is None:
            yield point, point
            continue
        partners = [other for other in points if _is_partner(study, point, other, check.than)]
        if len(partners) == 1:
            yield point, partners[0]
        elif partners or not _policy_is_missing(points, check.than):
            raise NoOnePartnerError(f"what fits {len(partners)} points" if partners else "what fits no point")


def _is_partner(study: Study, point: Point, other: Point, than: Mapping[str, Any]) -> bool:
    """Whether `other` is as `than` says, and as `point` on every axis that `than` leaves alone."""
    own, theirs = dict(point.labels), dict(other.labels)
    kept = [key for axis in _untouched(study, than) for key in axis]
    return matches(other, than) and all(own[key] == theirs[key] for key in kept)


def _untouched(study: Study, than: Mapping[str, Any]) -> Iterator[set[str]]:
    named = {part for key in than for part in _MADE_OF.get(key, {key})}
    for keys in (*(set(axis) for axis in study.sweep), *([{FAULTS}] if study.faults else []), {POLICY}):
        if not keys & named:
            yield keys


def _policy_is_missing(points: Sequence[Point], than: Mapping[str, Any]) -> bool:
    return POLICY in than and not any(matches(point, {POLICY: than[POLICY]}) for point in points)
