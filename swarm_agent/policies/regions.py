"""Regions (Jung & Sukhatme, the paper's references 10 and 11, as its section 2 tells them): agents go where targets are
many and agents few, and follow local centers of gravity.

PAPER: what section 2 leaves open is chosen here: square regions, the urgency, the threshold, and who leaves.
"""

from __future__ import annotations

from math import floor, sqrt

from swarm_agent.bcmommt.behaviors import MATE_FADES_S, capped, follow, look_around
from swarm_agent.bcmommt.belief import FAR, NOBODY, Table, predicted_place
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Explore, Params
from swarm_agent.bcmommt.prediction import predicted_distance
from swarm_agent.bcmommt.step import Mind, explore, next_mind
from swarm_agent.bcmommt.tags import tag_all_sensed

# The side of a region is about this many sensing ranges: neighboring regions are within the radio's range.
SIDE_PER_RANGE = 4.0
# An agent moves to regions with more targets to an agent than this.
TARGETS_PER_AGENT = 1.0


def decide(
    t: Table, p: Params, mind: Mind, me: int, x: float, y: float, now: float, seed: int, tick: int
) -> tuple[Mind, float, float]:
    """What agent `me` at (x, y) does now: see `bcmommt.step.decide`, whose arguments and result these are.

    It moves to a region that needs it more, else follows the center of gravity of what it sees, else looks for what its
    own region is known to hold, else explores.
    """
    if p.explore == Explore.STALE_FIRST:
        look_around(t, p, x, y, now)
    n_tags = tag_all_sensed(t)
    mode = Mode.FOLLOW if n_tags > 0 else Mode.EXPLORE
    mind = next_mind(mind, mode, NOBODY, FAR)
    here = region_of(p, x, y)
    there = most_urgent(t, p, me, here, x, y, now)
    if there == here and n_tags > 0:
        vx, vy = follow(t, p, x, y)
        return mind, vx, vy
    n, cx, cy = targets_in(t, p, there, x, y, now)
    if n > 0:
        gain = p.follow_gain_per_s
        vx, vy = capped((cx - x) * gain, (cy - y) * gain, p.agent_speed_m_s)
        return mind, vx, vy
    return explore(t, p, mind, me, x, y, now, seed, tick)


def columns_of(p: Params) -> int:
    """How many regions lie side by side, east-west, over the arena."""
    return max(1, floor(2.0 * p.arena.half_x_m / (SIDE_PER_RANGE * p.sensing_range_m) + 0.5))


def rows_of(p: Params) -> int:
    """How many regions lie side by side, north-south, over the arena."""
    return max(1, floor(2.0 * p.arena.half_y_m / (SIDE_PER_RANGE * p.sensing_range_m) + 0.5))


def region_of(p: Params, x: float, y: float) -> int:
    """The region in which (x, y) lies, counted from the south-west, row by row; outside the arena the nearest one."""
    columns, rows = columns_of(p), rows_of(p)
    column = floor((x / p.arena.half_x_m + 1.0) * 0.5 * columns)
    row = floor((y / p.arena.half_y_m + 1.0) * 0.5 * rows)
    return min(max(row, 0), rows - 1) * columns + min(max(column, 0), columns - 1)


def targets_in(t: Table, p: Params, region: int, me_x: float, me_y: float, now: float) -> tuple[int, float, float]:
    """How many targets are known in a region, sensed or predicted, and their center of gravity; (0, 0, 0) if none."""
    n = 0
    sum_x = sum_y = 0.0
    for j in t.known:
        if t.sensed[j] or predicted_distance(t, p, j, me_x, me_y, now) < FAR:
            x, y = predicted_place(t, p, j, now)
            if region_of(p, x, y) == region:
                n += 1
                sum_x += x
                sum_y += y
    if n == 0:
        return 0, 0.0, 0.0
    return n, sum_x / n, sum_y / n


def mates_in(t: Table, p: Params, region: int, now: float) -> int:
    """How many mates heard of lately are in a region."""
    n = 0
    for mate in t.mates:
        if now - t.mate_at_s[mate] <= MATE_FADES_S and region_of(p, t.mate_x_m[mate], t.mate_y_m[mate]) == region:
            n += 1
    return n


def most_urgent(t: Table, p: Params, me: int, here: int, me_x: float, me_y: float, now: float) -> int:
    """The region where agent `me` is needed most; `here`, its own, where it is needed as much as anywhere.

    The urgency of a region is its number of targets to an agent, `me` there too, less for one far away: half of it at
    the distance of a region's side. Elsewhere there must be more targets to an agent than the threshold. So an agent
    that moves never finds, on arrival, the region it left to be the more urgent one.
    """
    side = SIDE_PER_RANGE * p.sensing_range_m
    best = here
    best_urgency = targets_in(t, p, here, me_x, me_y, now)[0] / (mates_in(t, p, here, now) + 1)
    for region in range(columns_of(p) * rows_of(p)):
        n, x, y = targets_in(t, p, region, me_x, me_y, now)
        if n > 0 and region != here:
            mates = mates_in(t, p, region, now)
            dx, dy = x - me_x, y - me_y
            urgency = n / (mates + 1) * side / (side + sqrt(dx * dx + dy * dy))
            crowded = n > TARGETS_PER_AGENT * mates
            if crowded and urgency > best_urgency and not mate_goes(t, p, me, here, x, y, me_x, me_y, now):
                best, best_urgency = region, urgency
    return best


def mate_goes(
    t: Table, p: Params, me: int, here: int, x: float, y: float, me_x: float, me_y: float, now: float
) -> bool:
    """Whether a mate in my region is nearer to (x, y) (equal distances: the lower id). One agent at a time leaves."""
    dx, dy = x - me_x, y - me_y
    mine2 = dx * dx + dy * dy
    for mate in t.mates:
        if now - t.mate_at_s[mate] <= MATE_FADES_S and region_of(p, t.mate_x_m[mate], t.mate_y_m[mate]) == here:
            dx, dy = x - t.mate_x_m[mate], y - t.mate_y_m[mate]
            theirs2 = dx * dx + dy * dy
            if theirs2 < mine2 or (theirs2 == mine2 and mate < me):
                return True
    return False
