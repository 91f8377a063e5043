"""Between the table and the radio: hearing a mate's frame, and saying what the agent decided."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

from comms.messages import MAX_CALLS, MAX_TAGS, Answer, Frame, HelpCall, Tag
from swarm_agent.bcmommt.belief import NOBODY, Table, hear_answer, hear_call, hear_mate, hear_position, hear_tag
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Params
from swarm_agent.bcmommt.step import Mind


def hear(t: Table, p: Params, frames: Sequence[Frame]) -> None:
    """Enter a tick's frames into the table; what they say does not depend on their order.

    Agents and targets that the table has no row for are not ours, and are skipped: a radio has refused them already.
    """
    known = [frame for frame in frames if frame.src < len(t.mate_at_s)]
    for frame in known:  # first all that is withdrawn: it must not outrank what another repeats
        hear_mate(t, frame.src, frame.position_m[0], frame.position_m[1], frame.sent_at_s)
    for frame in known:
        _hear_one(t, p, frame)


def _hear_one(t: Table, p: Params, frame: Frame) -> None:
    mate, at, n_targets = frame.src, frame.sent_at_s, len(t.owner)
    for j, x, y, vx, vy, distance in frame.tags:
        if j < n_targets:
            hear_position(t, j, x, y, vx, vy, at)
            hear_tag(t, p, j, mate, distance, at)
    for j, x, y, vx, vy, loss_in, seen_ago in frame.help_calls:
        if j < n_targets:
            hear_position(t, j, x, y, vx, vy, at - seen_ago)
            hear_call(t, p, j, mate, at + loss_in, at)
    for j, capture in frame.answers:
        if j < n_targets:
            hear_answer(t, p, j, mate, capture, at)


def tags_said(t: Table) -> tuple[Tag, ...]:
    """The tags to broadcast. What does not fit into a frame is free for others to claim."""
    mine = list(islice((j for j in t.known if t.tagged[j]), MAX_TAGS))
    return tuple([Tag(j, t.x_m[j], t.y_m[j], t.vx_m_s[j], t.vy_m_s[j], t.distance_m[j]) for j in mine])


def calls_said(t: Table, p: Params, now: float) -> tuple[HelpCall, ...]:
    """The help calls to broadcast; a target lost already is lost in 0 s."""
    mine = list(islice((j for j in t.known if t.calling[j]), MAX_CALLS))
    return tuple(
        [
            HelpCall(j, t.x_m[j], t.y_m[j], t.vx_m_s[j], t.vy_m_s[j], _loss_in(t, p, j), now - t.known_at_s[j])
            for j in mine
        ]
    )


def _loss_in(t: Table, p: Params, j: int) -> float:
    return min(t.loss_in_s[j], p.horizon_s) if t.tagged[j] else 0.0


def answers_said(mind: Mind) -> tuple[Answer, ...]:
    """The answer to broadcast, if the agent helps."""
    if mind.mode != Mode.HELP or mind.helping == NOBODY:
        return ()
    return (Answer(mind.helping, mind.capture_s),)
