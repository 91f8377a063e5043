"""Who owns a target: the tagging of section 4.1 and definition 3. The nearest agent tags, the others drop the tag."""

from __future__ import annotations

from swarm_agent.bcmommt.belief import FAR, NOBODY, Table, answered_by_mate, called_by_mate, outranks, owned_by_mate
from swarm_agent.bcmommt.params import Params


def claim_tags(t: Table, p: Params, me: int, helping: int, now: float) -> int:
    """Fill `t.tagged` with TT, the targets that `me` tags now. Returns how many.

    Args:
        helping: the target of the call that `me` is on its way to, or NOBODY.
    """
    count = 0
    for j in t.known:
        t.tagged[j] = t.sensed[j] and may_tag(t, p, j, helping, now) and not yields(t, p, j, me, now)
        if t.tagged[j]:
            count += 1
    return count


def tag_all_sensed(t: Table) -> int:
    """Fill `t.tagged` with everything sensed, for policies in which nobody owns a target nor calls. Returns how many.

    A tag then only tells the mates which targets are observed, and where.
    """
    count = 0
    for j in t.known:
        t.tagged[j] = t.sensed[j]
        t.calling[j] = False
        t.loss_in_s[j] = FAR
        if t.tagged[j]:
            count += 1
    return count


def yields(t: Table, p: Params, j: int, me: int, now: float) -> bool:
    """Whether a mate's claim on target j beats mine: it is nearer (equal distances: the lower id).

    PAPER: the text compares "the distance in the tag" with the distance now. A mate's claim is one tick old, so it is
    compared with the distance that I had in that same tick; else both may drop the target for a moment.
    """
    if not owned_by_mate(t, p, j, now):
        return False
    own = t.distance_m[j]
    if t.distance_before_m[j] < FAR and now - t.owner_at_s[j] > 0.5 * p.tick_s:
        own = t.distance_before_m[j]
    return outranks(t.owner_distance_m[j], t.owner[j], own, me)


def may_tag(t: Table, p: Params, j: int, helping: int, now: float) -> bool:
    """Section 4.2.2: on its way to help, a robot tags only its call's target, and targets that are not safe already.

    Safe is a target with an owner, or with a call that somebody else has answered. Theorem 2 needs this rule.

    PAPER: there every called target is in its caller's sight. Ours may be lost already (`remember_losses`): whoever
    sees such a one takes it, answered or not.
    """
    if helping in (NOBODY, j):
        return True
    if owned_by_mate(t, p, j, now):
        return False
    if not answered_by_mate(t, p, j, now):
        return True
    lost: bool = called_by_mate(t, p, j, now) and t.call_loss_at_s[j] <= now
    return lost


def nearest_tag(t: Table) -> int:
    """The tagged target nearest to the agent, NOBODY if there is none (equal distances: the lower target)."""
    best = NOBODY
    for j in t.known:
        if t.tagged[j] and (best == NOBODY or t.distance_m[j] < t.distance_m[best]):
            best = j
    return best
