"""What the paper states, against what was measured: the intervals decide, and the words follow from the numbers.

A check is confirmed when all of its 95 % interval agrees with it, refuted when none of it does, and open in between.
A claim is refuted by one refuted check, and confirmed when all are. Checks are not corrected for their number.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import inf, isinf

from missions.study.flown import Flown
from missions.study.metrics import QUANTITIES, Floats, Quantity, Window
from missions.study.model import Check, Claim
from missions.study.pairs import compares_policies, pairs
from missions.study.points import POLICY, Point
from missions.study.results import Results
from missions.study.statistics import Estimate, estimate
from missions.study.words import point_words, telling_keys


class Verdict(StrEnum):
    """What comes of a claim."""

    CONFIRMED = "confirmed"
    REFUTED = "refuted"
    OPEN = "open"
    """The interval holds both: more runs may tell."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One check of one pair of points: in words what was measured, and what follows."""

    measured: str
    verdict: Verdict


@dataclass(frozen=True, slots=True)
class Judgement:
    """A claim, for one policy (None: it compares policies)."""

    claim: Claim
    policy: str | None
    findings: tuple[Finding, ...]

    @property
    def verdict(self) -> Verdict:
        """Refuted by one finding, confirmed by all."""
        verdicts = {finding.verdict for finding in self.findings}
        for decisive in (Verdict.REFUTED, Verdict.OPEN):
            if decisive in verdicts:
                return decisive
        return Verdict.CONFIRMED


def judged(results: Results) -> list[Judgement]:
    """Every claim of the study about points that were flown, policy by policy."""
    ready = results.ready
    policies = dict.fromkeys(dict(point.labels)[POLICY] for point in ready.points)
    found = []
    for claim in ready.study.claims:
        for policy in [None] if compares_policies(claim) else policies:
            points = [p for p in ready.points if policy is None or dict(p.labels)[POLICY] == policy]
            findings = tuple(finding for check in claim.checks for finding in _findings(results, points, check))
            if findings:
                found.append(Judgement(claim, policy, findings))
    return found


def _findings(results: Results, points: Sequence[Point], check: Check) -> Iterator[Finding]:
    keys = telling_keys(points)
    for point, other in pairs(results.ready.study, points, check):
        one, two = _Side(results, point, check, other=False), _Side(results, other, check, other=True)
        about = point_words(point, keys)
        if check.value is not None:
            yield _against_value(one, about, check)
        elif check.expect == "closer":
            yield _closer(one, two, about, point_words(other, keys))
        else:
            differing = [key for key in keys if dict(point.labels)[key] != dict(other.labels)[key]]
            yield _difference(one, two, about, point_words(other, differing), check)


class _Side:
    """One of the two numbers of a check."""

    def __init__(self, results: Results, point: Point, check: Check, *, other: bool) -> None:
        self.flown: Flown = results.of(point)
        metric, self.window = check.metric, Window(check.from_s, check.until_s)
        if other:
            metric = check.than_metric or metric
            moved = check.than_from_s is not None or check.than_until_s is not None or check.than_metric is not None
            self.window = Window(check.than_from_s or 0.0, check.than_until_s) if moved else self.window
        self.quantity: Quantity = QUANTITIES[metric]

    @property
    def values(self) -> Floats:
        return self.quantity.of(self.flown, self.window)

    def values_in(self, window: Window) -> Floats:
        return self.quantity.of(self.flown, window)

    @property
    def words(self) -> str:
        return f"{self.quantity.label} {self.window}".rstrip()

    @property
    def shown(self) -> str:
        return shown_estimate(self.quantity, estimate(self.values))


def shown_estimate(quantity: Quantity, told: Estimate) -> str:
    """A mean and its interval: "93.1 % ± 0.4"."""
    return quantity.with_spread(told.mean, told.half)


def _against_value(side: _Side, about: str, check: Check) -> Finding:
    assert check.value is not None, "called for checks with a value"
    told = estimate(side.values)
    middle = check.value
    verdict = _verdict(told, *_allowed(check, middle))
    allowed = {"about": "within", "above": "more by", "below": "less by"}.get(check.expect, "within")
    margin = f", {allowed} {side.quantity.spread(check.within)}" if check.within else ""
    wanted = f"{check.expect} {side.quantity.shown(middle)}{margin}"
    return Finding(f"{_of(about)}{side.words} {side.shown} (claimed {wanted})", verdict)


def _difference(one: _Side, two: _Side, about: str, other: str, check: Check) -> Finding:
    told = estimate(one.values - two.values)
    if check.expect == "insignificant":
        verdict = Verdict.CONFIRMED if told.low <= 0 <= told.high else Verdict.REFUTED
        if isinf(told.low):
            verdict = Verdict.OPEN
    else:
        verdict = _verdict(told, *_allowed(check, 0.0))
    left = f"{_of(about)}{one.words} {one.shown}"
    # Of the same point it is the words that differ: another time, or another number.
    return Finding(f"{left}, {other or two.words} {two.shown}: {_change(one.quantity, told)}", verdict)


def _closer(one: _Side, two: _Side, about: str, other: str) -> Finding:
    """Whether two points differ less in the check's window than in that of `than`."""
    now = one.values - two.values_in(one.window)
    before = one.values_in(two.window) - two.values
    sign = 1.0 if before.mean() >= 0 else -1.0
    told = estimate(sign * (before - now))
    quantity = one.quantity
    gap_before, gap_now = (quantity.spread(sign * float(gap.mean())) for gap in (before, now))
    gaps = f"{gap_before} points {two.window}, {gap_now} {one.window}"
    words = f"{about} and {other} are apart by {gaps}: {_change(quantity, told)} closer"
    return Finding(words, _verdict(told, 0.0, inf))


def _allowed(check: Check, middle: float) -> tuple[float, float]:
    """Between which numbers a check holds."""
    if check.expect == "above":
        return middle + check.within, inf
    if check.expect == "below":
        return -inf, middle - check.within
    return middle - check.within, middle + check.within


def _verdict(told: Estimate, low: float, high: float) -> Verdict:
    if told.low > low and told.high < high:
        return Verdict.CONFIRMED
    if told.high <= low or told.low >= high:
        return Verdict.REFUTED
    return Verdict.OPEN


def _change(quantity: Quantity, told: Estimate) -> str:
    if quantity.is_share:
        return f"{100 * told.mean:+.1f} ± {quantity.spread(told.half)} points"
    return f"{told.mean:+.3g} ± {quantity.spread(told.half)}"


def _of(about: str) -> str:
    return f"{about}: " if about else ""
