"""Where to fly in each mode. Every function returns a velocity (east, north) in m/s, at most s_v long."""

from __future__ import annotations

from math import sqrt

from comms.arena import edge_distance_m, outward_normal
from comms.chance import EXPLORE_TURN, draw
from swarm_agent.bcmommt.belief import (
    FAR,
    NEVER,
    NOBODY,
    Table,
    cell_columns,
    cell_rows,
    cell_x,
    cell_y,
    predicted_place,
    see_cells,
)
from swarm_agent.bcmommt.params import Params

# Persistent walk: the heading diffuses by about 0.3 rad in a second, and turns away from mates and the edge.
WALK_TURN_RAD_SQRT_S = 0.3
REPULSION_PER_S = 1.0
# A mate that has not been heard for so long is not where it was.
MATE_FADES_S = 2.0
# Cells never seen count as seen so long ago: enough to be first, little enough for the way there to matter.
STALE_AT_MOST_S = 600.0


def capped(vx: float, vy: float, speed: float) -> tuple[float, float]:
    """(vx, vy) shortened to `speed` if it is longer (the min of eq. 7)."""
    norm = sqrt(vx * vx + vy * vy)
    if norm <= speed:
        return vx, vy
    return vx * speed / norm, vy * speed / norm


def follow(t: Table, p: Params, me_x: float, me_y: float) -> tuple[float, float]:
    """To the center of gravity of one's own tags, plus its velocity; `standoff_m` short of it where that is wanted.

    PAPER: eq. 7 sums unit vectors, which balance at a point other than the center of gravity that eq. 10 assumes.
    """
    x = y = vx = vy = 0.0
    n = 0
    for j in t.known:
        if t.tagged[j]:
            x += t.x_m[j]
            y += t.y_m[j]
            vx += t.vx_m_s[j]
            vy += t.vy_m_s[j]
            n += 1
    return pursue(p, x / n - me_x, y / n - me_y, vx / n, vy / n)


def pursue(p: Params, dx: float, dy: float, vx: float, vy: float) -> tuple[float, float]:
    """To a point (dx, dy) away that moves at (vx, vy), `standoff_m` short of it where that is wanted."""
    if p.standoff_m > 0.0:
        distance = sqrt(dx * dx + dy * dy)
        if distance > 1e-6:
            share = (distance - p.standoff_m) / distance
            dx, dy = dx * share, dy * share
    gain = p.follow_gain_per_s
    return capped(dx * gain + vx, dy * gain + vy, p.agent_speed_m_s)


def approach(t: Table, p: Params, j: int, me_x: float, me_y: float, now: float) -> tuple[float, float]:
    """At full speed to where target j is predicted to be now, slowing down only on top of it."""
    gain = p.follow_gain_per_s
    x, y = predicted_place(t, p, j, now)
    dx, dy = x - me_x, y - me_y
    return capped(dx * gain + t.vx_m_s[j], dy * gain + t.vy_m_s[j], p.agent_speed_m_s)


def walk(
    t: Table,
    p: Params,
    heading_x: float,
    heading_y: float,
    me: int,
    me_x: float,
    me_y: float,
    now: float,
    seed: int,
    tick: int,
) -> tuple[float, float]:
    """Explore by persistent walk: the next heading, a unit vector. Repelled by mates within 2 r_s and by the edge."""
    reach = 2.0 * p.sensing_range_m
    turn = (2.0 * draw(seed, tick, me, EXPLORE_TURN) - 1.0) * WALK_TURN_RAD_SQRT_S * sqrt(3.0 * p.tick_s)
    hx = heading_x - turn * heading_y
    hy = heading_y + turn * heading_x
    push = REPULSION_PER_S * p.tick_s
    for mate in t.mates:
        if now - t.mate_at_s[mate] <= MATE_FADES_S:
            dx, dy = me_x - t.mate_x_m[mate], me_y - t.mate_y_m[mate]
            distance = sqrt(dx * dx + dy * dy)
            if 1e-6 < distance < reach:
                weight = push * (1.0 - distance / reach) / distance
                hx += weight * dx
                hy += weight * dy
    inside = edge_distance_m(p.arena, me_x, me_y)
    if inside < p.sensing_range_m:
        nx, ny = outward_normal(p.arena, me_x, me_y)
        weight = 2.0 * push * (1.0 - inside / p.sensing_range_m)
        hx -= weight * nx
        hy -= weight * ny
    norm = sqrt(hx * hx + hy * hy)
    if norm < 1e-9:
        return heading_x, heading_y
    return hx / norm, hy / norm


def stalest_cell(t: Table, p: Params, me_x: float, me_y: float, now: float) -> int:
    """Explore stale-first: the cell unseen for longest, less the way there; mates' nearer cells are left to them."""
    best, best_score = NOBODY, -FAR
    for cell in range(cell_columns(p) * cell_rows(p)):
        x, y = cell_x(p, cell), cell_y(p, cell)
        if edge_distance_m(p.arena, x, y) < 0.0:
            continue
        dx, dy = x - me_x, y - me_y
        mine2 = dx * dx + dy * dy
        score = min(now - t.cell_seen_at_s[cell], STALE_AT_MOST_S) - sqrt(mine2) / p.agent_speed_m_s
        if score > best_score and not _mate_is_nearer(t, x, y, mine2, now):
            best, best_score = cell, score
    return best


def _mate_is_nearer(t: Table, x: float, y: float, mine2: float, now: float) -> bool:
    for mate in t.mates:
        if now - t.mate_at_s[mate] <= MATE_FADES_S:
            dx, dy = x - t.mate_x_m[mate], y - t.mate_y_m[mate]
            if dx * dx + dy * dy < mine2:
                return True
    return False


def look_around(t: Table, p: Params, me_x: float, me_y: float, now: float) -> None:
    """Note what is seen now: by me, and by the mates heard of lately, for the stale-first search."""
    see_cells(t, p, me_x, me_y, now)
    for mate in t.mates:
        if now - t.mate_at_s[mate] <= MATE_FADES_S:
            see_cells(t, p, t.mate_x_m[mate], t.mate_y_m[mate], t.mate_at_s[mate])


def is_seen_since(t: Table, cell: int, since: float) -> bool:
    """Whether anybody has seen the cell after `since`; true for NOBODY's cell."""
    if cell == NOBODY:
        return True
    seen_at: float = t.cell_seen_at_s[cell]
    return seen_at > since and seen_at > NEVER
