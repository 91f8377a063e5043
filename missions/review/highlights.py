"""What stands out in a mission, in a few sentences: faults that cost coverage, long losses, calls in vain."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from math import inf
from typing import NamedTuple

from missions.review.calls import Fate
from missions.review.losses import Loss
from missions.review.reading import Review
from missions.review.timeline import why_it_did_not
from missions.review.words import agent, agents, clock, percent, target

_MOST_FAULTS, _MOST_LOSSES = 3, 4
# What coverage varies by without any fault, and how long a target is out of hands when it only passes between them.
_COST, LONG_S = 0.05, 10.0
_WHEN = {"before": "of the targets were seen before", "during": "meanwhile", "after": "afterwards"}


class Highlight(NamedTuple):
    """One sentence, and when (mission clock) what it says began; None: it is about the whole mission."""

    time_s: float | None
    text: str


def highlights(review: Review) -> list[Highlight]:
    """What stands out, in order of time; what is about all of the mission comes last."""
    found = [*_costly_faults(review), *_long_losses(review)]
    found.sort(key=lambda one: one.time_s or 0.0)
    return [*found, *_calls_in_vain(review)]


def _costly_faults(review: Review) -> Iterator[Highlight]:
    costs = []
    for fault in review.report["injected"]:
        before, during, after = (fault["coverage"][when] for when in ("before", "during", "after"))
        known = [share for share in (during, after) if share is not None]
        if before is not None and known and before - min(known) >= _COST:
            costs.append((before - min(known), fault))
    costs.sort(key=lambda cost: -cost[0])
    for _, fault in costs[:_MOST_FAULTS]:
        shares = ((fault["coverage"][when], words) for when, words in _WHEN.items())
        seen = ", ".join(f"{percent(share)} {words}" for share, words in shares if share is not None)
        yield Highlight(fault["at_s"] + (review.began_s or 0.0), f"{fault['what']}, {fault['whom']}: {seen}")


def _long_losses(review: Review) -> Iterator[Highlight]:
    """The longest."""
    long = [loss for loss in review.losses if not loss.left and (loss.found_after_s or inf) > LONG_S]
    long.sort(key=lambda loss: -(loss.found_after_s or inf))
    for loss in long[:_MOST_LOSSES]:
        lasted = "for good" if loss.found_after_s is None else f"for {loss.found_after_s:.0f} s"
        yield Highlight(loss.time_s, f"{target(loss.target)} is lost {lasted}: {_why(loss)}")


def _why(loss: Loss) -> str:
    owners = agents(loss.owners)
    if loss.owners_gone:
        return f"{owners}, which had it, was out" if len(loss.owners) == 1 else f"{owners}, which had it, were out"
    if loss.chances:
        best = loss.chances[0]
        return f"it got away from {owners}; {agent(best.agent)} was free and near enough: {why_it_did_not(best)}"
    if loss.helpers:
        return f"it got away from {owners}; {agents(loss.helpers)} came too late"
    return f"it got away from {owners}, and nobody free was near enough"


def _calls_in_vain(review: Review) -> Iterator[Highlight]:
    fates = Counter(call.fate for call in review.calls)
    if fates[Fate.LOST]:
        yield Highlight(None, f"{fates[Fate.LOST]} of {len(review.calls)} help calls ended with the target lost")


def told(one: Highlight) -> tuple[str, str]:
    """When, and what: a row of a table."""
    return ("" if one.time_s is None else clock(one.time_s)), one.text
