"""B-CMOMMT as first published (section 4.1): three modes and tags, help called for what is out of sight already.

A call names no place and no time: helpers go at once to the caller, and nobody answers.
"""

from __future__ import annotations

from math import sqrt

from comms.messages import on_wire
from swarm_agent.bcmommt.behaviors import approach, capped, follow, look_around
from swarm_agent.bcmommt.belief import FAR, NEVER, NOBODY, Table, called_by_mate, owned_by_mate
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Explore, Params
from swarm_agent.bcmommt.prediction import in_predictive_tracking, predicted_distance
from swarm_agent.bcmommt.step import Mind, explore, next_mind
from swarm_agent.bcmommt.tags import claim_tags


def decide(
    t: Table, p: Params, mind: Mind, me: int, x: float, y: float, now: float, seed: int, tick: int
) -> tuple[Mind, float, float]:
    """What agent `me` at (x, y) does now: see `bcmommt.step.decide`, whose arguments and result these are."""
    if p.explore == Explore.STALE_FIRST:
        look_around(t, p, x, y, now)
    issue_calls(t, p, x, y, now)
    n_tags = claim_tags(t, p, me, NOBODY, now)
    if n_tags > 0:
        vx, vy = follow(t, p, x, y)
        return next_mind(mind, Mode.FOLLOW, NOBODY, FAR), vx, vy

    j = own_loss(t, p, x, y, now)
    if j != NOBODY:
        vx, vy = approach(t, p, j, x, y, now)
        return _helping(mind, p, j, predicted_distance(t, p, j, x, y, now)), vx, vy
    j, distance = nearest_caller(t, p, x, y, now)
    if j != NOBODY:
        gain, caller = p.follow_gain_per_s, t.caller[j]
        vx, vy = capped((t.mate_x_m[caller] - x) * gain, (t.mate_y_m[caller] - y) * gain, p.agent_speed_m_s)
        return _helping(mind, p, j, distance), vx, vy
    return explore(t, p, next_mind(mind, Mode.EXPLORE, NOBODY, FAR), me, x, y, now, seed, tick)


def issue_calls(t: Table, p: Params, me_x: float, me_y: float, now: float) -> None:
    """Fill `t.calling`: the targets that this agent was the last to own and that are in predictive tracking now.

    To be called before `claim_tags`: it reads the tags of one tick ago.
    """
    for j in t.known:
        if t.sensed[j] or owned_by_mate(t, p, j, now):
            t.lost_at_s[j] = NEVER
        elif t.tagged[j]:
            t.lost_at_s[j] = now
        t.calling[j] = t.lost_at_s[j] > NEVER and in_predictive_tracking(t, p, j, me_x, me_y, now)
        t.loss_in_s[j] = FAR


def own_loss(t: Table, p: Params, me_x: float, me_y: float, now: float) -> int:
    """The target nearest to the agent of those it calls for, NOBODY if there is none.

    PAPER: the text does not say what a robot does whose last target has just left its sight. Ours answers its own call
    first, by predictive tracking: it is the nearest to help.
    """
    best, best_distance = NOBODY, FAR
    for j in t.known:
        if t.calling[j]:
            distance = predicted_distance(t, p, j, me_x, me_y, now)
            if distance < best_distance:
                best, best_distance = j, distance
    return best


def nearest_caller(t: Table, p: Params, me_x: float, me_y: float, now: float) -> tuple[int, float]:
    """A target of the nearest mate that calls, and how far that mate is; (NOBODY, FAR) if nobody calls.

    PAPER: of several callers the text names none. Every helper goes, however many others do.
    """
    best, best_distance = NOBODY, FAR
    for j in t.known:
        if called_by_mate(t, p, j, now):
            dx, dy = t.mate_x_m[t.caller[j]] - me_x, t.mate_y_m[t.caller[j]] - me_y
            distance = sqrt(dx * dx + dy * dy)
            if distance < best_distance:
                best, best_distance = j, distance
    return best, best_distance


def _helping(mind: Mind, p: Params, j: int, distance: float) -> Mind:
    """On its way; what it says of its time of arrival is for observers, no mate acts on it."""
    return next_mind(mind, Mode.HELP, j, on_wire(distance / p.agent_speed_m_s))
