"""What an agent knows, for the observer: its table with what still holds in it, and the reason for what it does."""

from __future__ import annotations

from comms.knowledge import Belief, Knowledge, Mate
from swarm_agent.bcmommt.belief import (
    FAR,
    SHOWN_S,
    Table,
    answered_by_mate,
    called_by_mate,
    owned_by_mate,
    predicted_place,
)
from swarm_agent.bcmommt.help import is_lost, time_until_loss
from swarm_agent.reasons import Reasons


def insight(reasons: Reasons, *, wanted_m_s: tuple[float, float], mavlink: tuple[bytes, ...]) -> Knowledge:
    """The agent's knowledge after it has decided."""
    t, now = reasons.table, reasons.now_s
    return Knowledge(
        beliefs=tuple([_belief(reasons, j) for j in t.known if _is_shown(reasons, j)]),
        mates=tuple(
            [
                Mate(mate, (t.mate_x_m[mate], t.mate_y_m[mate]), now - t.mate_at_s[mate])
                for mate in t.mates
                if now - t.mate_at_s[mate] <= SHOWN_S
            ]
        ),
        wanted_m_s=wanted_m_s,
        why=reasons.why,
        mavlink=mavlink,
    )


def _is_shown(reasons: Reasons, j: int) -> bool:
    t, now = reasons.table, reasons.now_s
    return now - t.known_at_s[j] <= SHOWN_S or _is_called(reasons, j)


def _is_called(reasons: Reasons, j: int) -> bool:
    t, p, now = reasons.table, reasons.params, reasons.now_s
    return called_by_mate(t, p, j, now) or is_lost(t, p, j, now)


def _belief(reasons: Reasons, j: int) -> Belief:
    t, p, now = reasons.table, reasons.params, reasons.now_s
    mine, answered = bool(t.tagged[j]), answered_by_mate(t, p, j, now)
    owner = reasons.uid if mine else _who(t.owner[j], owned_by_mate(t, p, j, now))
    caller = reasons.uid if t.calling[j] else _who(t.caller[j], called_by_mate(t, p, j, now))
    helps = reasons.mind.helping == j
    return Belief(
        target=j,
        place_m=predicted_place(t, p, j, now),
        age_s=now - t.known_at_s[j],
        sensed=bool(t.sensed[j]),
        owner=owner,
        caller=caller,
        loss_in_s=_loss_in_s(t, reasons, j, mine=mine, caller=caller),
        answerer=reasons.uid if helps else _who(t.answerer[j], answered),
        capture_s=_finite(reasons.mind.capture_s) if helps else t.answer_capture_s[j] if answered else None,
    )


def _loss_in_s(t: Table, reasons: Reasons, j: int, *, mine: bool, caller: int | None) -> float | None:
    if mine:
        return _finite(t.loss_in_s[j])
    if caller is None:
        return None
    return time_until_loss(t, reasons.params, j, reasons.now_s)


def _who(speaker: int, holds: bool) -> int | None:
    return speaker if holds else None


def _finite(seconds: float) -> float | None:
    return None if seconds >= FAR else seconds
