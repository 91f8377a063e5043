"""Help calls: which to issue, which to answer, when to let go (section 4.2.2, "Modified help calls")."""

from __future__ import annotations

from math import sqrt

from comms.messages import on_wire
from swarm_agent.bcmommt.belief import (
    FAR,
    NEVER,
    NOBODY,
    Table,
    answered_by_mate,
    called_by_mate,
    outranks,
    owned_by_mate,
    predicted_place,
)
from swarm_agent.bcmommt.params import Answering, Call, Gate, Params
from swarm_agent.bcmommt.reach import time_to_capture
from swarm_agent.bcmommt.tags import nearest_tag


def issue_calls(t: Table, p: Params, now: float) -> None:
    """Fill `t.calling`: the tags for which help is called, and the targets lost. Never the nearest tag: it is safe."""
    safe = nearest_tag(t)
    for j in t.known:
        if not t.tagged[j] and t.lost_at_s[j] == NEVER:
            t.calling[j] = False  # neither mine nor missed: most targets, most of the time
            continue
        wanted = t.loss_in_s[j] < FAR or p.call == Call.ALL_BUT_NEAREST
        t.calling[j] = (t.tagged[j] and j != safe and wanted) or is_lost(t, p, j, now)


def remember_losses(t: Table, p: Params, me_x: float, me_y: float, now: float) -> None:
    """Keep calling for targets that this agent was the last to own, for `memory_s`, unless somebody has them.

    PAPER: the text forgets a target the moment it is out of range. Ours stays a call at its predicted position. With
    `memory_s` 0 this does nothing. To be called before `claim_tags`: it reads the tags of one tick ago.
    """
    for j in t.known:
        if not t.tagged[j] and t.lost_at_s[j] == NEVER:
            continue  # neither mine nor missed
        if t.sensed[j] or owned_by_mate(t, p, j, now):
            t.lost_at_s[j] = NEVER
        elif t.tagged[j]:
            t.lost_at_s[j] = now
        elif now - t.lost_at_s[j] <= p.memory_s and _looks_empty(t, p, j, me_x, me_y, now):
            t.lost_at_s[j] = NEVER


def _looks_empty(t: Table, p: Params, j: int, me_x: float, me_y: float, now: float) -> bool:
    """Whether target j is not where it was expected: well within my sight, and not sensed there."""
    x, y = predicted_place(t, p, j, now)
    dx, dy = x - me_x, y - me_y
    return not t.sensed[j] and dx * dx + dy * dy < 0.25 * p.sensing_range_m * p.sensing_range_m


def is_lost(t: Table, p: Params, j: int, now: float) -> bool:
    """Whether this agent, its last owner, still looks for target j."""
    lost_for: float = now - t.lost_at_s[j]
    return lost_for < p.memory_s


def is_called(t: Table, p: Params, j: int, me_x: float, me_y: float, now: float) -> bool:
    """Whether a call for target j is in force: a mate's, or my own for one that I lost.

    A call whose target somebody other than the caller follows is settled, and one whose target is not where it should
    be leads nowhere.
    """
    if is_lost(t, p, j, now):
        return True
    if not called_by_mate(t, p, j, now) or (t.owner[j] != t.caller[j] and owned_by_mate(t, p, j, now)):
        return False
    return not _looks_empty(t, p, j, me_x, me_y, now)


def time_until_loss(t: Table, p: Params, j: int, now: float) -> float:
    """t_l: seconds until the called target is lost; 0 for one that is lost already."""
    if is_lost(t, p, j, now):
        return 0.0
    remaining: float = t.call_loss_at_s[j] - now
    return max(0.0, remaining)


def keeps(t: Table, p: Params, j: int, me: int, me_x: float, me_y: float, my_capture: float, now: float) -> bool:
    """Whether a commitment to the call for target j stands: the call lives and nobody quicker has taken it over.

    Args:
        my_capture: the time to capture that I broadcast one tick ago, as old as the mate's answer.
    """
    if p.answering == Answering.OPTIMAL:
        return True  # the referee has looked
    if not is_called(t, p, j, me_x, me_y, now):
        return False  # withdrawn, expired or settled. PAPER: Algorithm 1 has no way back from Help to Explore
    rival = answered_by_mate(t, p, j, now)
    return not (rival and outranks(t.answer_capture_s[j], t.answerer[j], my_capture, me))


def choose(
    t: Table, p: Params, me: int, me_x: float, me_y: float, helping: int, my_capture: float, now: float
) -> tuple[int, float]:
    """The call to answer, and its time to capture: the closest unanswered one (UH), else the closest in AH.

    AH holds the answered calls that I can reach quicker than whoever answers. "Closest" is the least T_r, then the
    least distance, then the lower target. Returns (NOBODY, FAR) if there is none.
    """
    if p.answering == Answering.OPTIMAL:
        return NOBODY, FAR  # not mine to choose
    best, best_capture, best_distance, best_unanswered = NOBODY, FAR, FAR, False
    for j in t.known:
        if t.caller[j] == NOBODY and t.lost_at_s[j] == NEVER:
            continue  # nobody has called for it: most targets, most of the time
        if not is_called(t, p, j, me_x, me_y, now):
            continue
        capture = time_if_answered(t, p, j, me_x, me_y, now)
        if capture >= FAR:
            continue
        unanswered = not answered_by_mate(t, p, j, now)
        if not unanswered:
            mine = my_capture if j == helping else on_wire(capture)
            if not outranks(mine, me, t.answer_capture_s[j], t.answerer[j]):
                continue
        x, y = predicted_place(t, p, j, now)
        dx, dy = x - me_x, y - me_y
        distance = sqrt(dx * dx + dy * dy)
        if unanswered == best_unanswered:
            better = capture < best_capture or (capture == best_capture and distance < best_distance)
        else:
            better = unanswered
        if better:
            best, best_capture, best_distance, best_unanswered = j, capture, distance, unanswered
    return best, best_capture


def time_if_answered(t: Table, p: Params, j: int, me_x: float, me_y: float, now: float) -> float:
    """T_r for the called target j, an element of the matrix H (eq. 15): FAR if the call may not be answered.

    PAPER: a call is answered when the capture comes BEFORE the loss (T_r < t_l; the text prints the reverse, the proof
    of theorem 1 needs this). With the gate ALWAYS that condition falls away.
    """
    capture = time_to_capture(t, p, j, me_x, me_y, now)
    if p.gate == Gate.IN_TIME and capture >= time_until_loss(t, p, j, now):
        return FAR
    return capture


def must_go(t: Table, p: Params, j: int, capture: float, now: float) -> bool:
    """Section 4.2.2: a helper keeps exploring while T_r <= t_l - h_m, then it flies to its target.

    PAPER: Algorithm 1 prints the margin 0, which starts too late.
    """
    return capture > time_until_loss(t, p, j, now) - p.help_margin_s
