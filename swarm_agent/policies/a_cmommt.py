"""A-CMOMMT (Parker, the paper's reference 18, and its eq. 2): targets draw, mates push, and the sum steers."""

from __future__ import annotations

from math import sqrt

from swarm_agent.bcmommt.behaviors import MATE_FADES_S, capped, look_around
from swarm_agent.bcmommt.belief import FAR, NOBODY, Table, owned_by_mate, predicted_place
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Explore, Params
from swarm_agent.bcmommt.prediction import in_predictive_tracking
from swarm_agent.bcmommt.profiles import agent_factor, target_factor
from swarm_agent.bcmommt.step import Mind, explore, next_mind
from swarm_agent.bcmommt.tags import tag_all_sensed

# PAPER: w of eq. 2 is "smaller than 1" for a target that another robot observes; public re-implementations use this.
SHARED_WEIGHT = 0.25
# In the very place of a target or a mate there is no direction to it.
SAME_PLACE_M = 1e-6


def decide(
    t: Table, p: Params, mind: Mind, me: int, x: float, y: float, now: float, seed: int, tick: int
) -> tuple[Mind, float, float]:
    """What agent `me` at (x, y) does now: see `bcmommt.step.decide`, whose arguments and result these are.

    PAPER: eq. 2 is a goal position relative to the agent; with `follow_gain_per_s` it is the velocity that eq. 7 caps.
    PAPER: with no target in reach eq. 2 would only leave mates and stand still elsewhere. Ours explores then, as the
    other policies do.
    """
    if p.explore == Explore.STALE_FIRST:
        look_around(t, p, x, y, now)
    n_tags = tag_all_sensed(t)
    mode = Mode.FOLLOW if n_tags > 0 else Mode.EXPLORE
    mind = next_mind(mind, mode, NOBODY, FAR)
    n_drawing, fx, fy = force(t, p, x, y, now)
    if n_drawing == 0:
        return explore(t, p, mind, me, x, y, now, seed, tick)
    vx, vy = capped(fx * p.follow_gain_per_s, fy * p.follow_gain_per_s, p.agent_speed_m_s)
    return mind, vx, vy


def force(t: Table, p: Params, me_x: float, me_y: float, now: float) -> tuple[int, float, float]:
    """Eq. 2: F, the sum of w f_t over targets and of f_r over mates, in m; and how many targets there are in it.

    Each f is a unit vector times its profile.
    """
    n, tx, ty = target_force(t, p, me_x, me_y, now)
    rx, ry = mate_force(t, p, me_x, me_y, now)
    return n, tx + rx, ty + ry


def target_force(t: Table, p: Params, me_x: float, me_y: float, now: float) -> tuple[int, float, float]:
    """The first sum of eq. 2: targets in sight and in predictive tracking; those that a mate observes count less."""
    n = 0
    fx = fy = 0.0
    for j in t.known:
        if t.sensed[j] or in_predictive_tracking(t, p, j, me_x, me_y, now):
            n += 1
            x, y = predicted_place(t, p, j, now)
            dx, dy = x - me_x, y - me_y
            distance = sqrt(dx * dx + dy * dy)
            if distance > SAME_PLACE_M:
                weight = SHARED_WEIGHT if owned_by_mate(t, p, j, now) else 1.0
                share = weight * target_factor(p, distance) / distance
                fx += share * dx
                fy += share * dy
    return n, fx, fy


def mate_force(t: Table, p: Params, me_x: float, me_y: float, now: float) -> tuple[float, float]:
    """The second sum of eq. 2: away from mates heard of lately."""
    fx = fy = 0.0
    for mate in t.mates:
        if now - t.mate_at_s[mate] <= MATE_FADES_S:
            dx, dy = t.mate_x_m[mate] - me_x, t.mate_y_m[mate] - me_y
            distance = sqrt(dx * dx + dy * dy)
            if distance > SAME_PLACE_M:
                share = agent_factor(p, distance) / distance
                fx += share * dx
                fy += share * dy
    return fx, fy
