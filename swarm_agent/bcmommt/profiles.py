"""The profiles of figure 1, the bound on the following distance (eq. 12): how strongly things draw an agent.

PAPER: figure 1 names its five distances and gives none. Ours are shares of r_s as public re-implementations have
them. d_o1 is `standoff_m`, and d_o3 the sensing range, beyond which targets are predicted.
"""

from __future__ import annotations

from swarm_agent.bcmommt.params import Params

FULL_PULL_PER_RANGE = 0.32  # d_o2
SLOPE_PER_RANGE = 0.16  # from d_o1 to d_o2 at least
PREDICTIVE_PER_RANGE = 1.2  # predictive tracking range
FULL_PUSH_PER_RANGE = 0.5  # d_r1
NO_PUSH_PER_RANGE = 0.8  # d_r2


def full_pull_m(p: Params) -> float:
    """d_o2: from here on a target draws in full. A wide standoff moves it outward, to the sensing range at most."""
    apart = max(FULL_PULL_PER_RANGE * p.sensing_range_m, p.standoff_m + SLOPE_PER_RANGE * p.sensing_range_m)
    return min(apart, p.sensing_range_m)


def predictive_range_m(p: Params) -> float:
    """The predictive tracking range: targets further away do not move the agent."""
    return PREDICTIVE_PER_RANGE * p.sensing_range_m


def target_factor(p: Params, distance: float) -> float:
    """Figure 1, left: the length of f_t. Negative pushes away, positive draws near.

    -1 at 0, through 0 at d_o1, to 1 at d_o2; 1 to d_o3; down to 0 at the predictive tracking range. Without a standoff
    (d_o1 = 0) nothing pushes: it rises from 0 at 0.
    """
    do1, do2, do3, reach = p.standoff_m, full_pull_m(p), p.sensing_range_m, predictive_range_m(p)
    if distance < do1:
        return distance / do1 - 1.0
    if distance < do2:
        return (distance - do1) / (do2 - do1)
    if distance <= do3:
        return 1.0
    if distance < reach:
        return (reach - distance) / (reach - do3)
    return 0.0


def agent_factor(p: Params, distance: float) -> float:
    """Figure 1, right: the length of f_r, which only pushes. -1 to d_r1, up to 0 at d_r2, and 0 beyond."""
    dr1, dr2 = FULL_PUSH_PER_RANGE * p.sensing_range_m, NO_PUSH_PER_RANGE * p.sensing_range_m
    if distance <= dr1:
        return -1.0
    if distance < dr2:
        return (distance - dr2) / (dr2 - dr1)
    return 0.0


def greatest_standoff_m(p: Params, robots: int) -> float:
    """Eq. 12: the greatest following distance d_o1 with which theorem 2 holds, `robots` being sensed by the agent.

    xi is how far an agent flies in the time that it needs to turn. A negative bound says that its sensing range is too
    short for so many neighbors, even right above its targets.
    """
    return p.sensing_range_m / (2.0 * (robots + 1)) - p.agent_speed_m_s * p.turn_time_s
