"""Algorithm 1, Move_robot(i): one pass of its loop, as a function of what one agent knows."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from comms.messages import on_wire
from swarm_agent.bcmommt.behaviors import approach, follow, is_seen_since, look_around, stalest_cell, walk
from swarm_agent.bcmommt.belief import FAR, NEVER, NOBODY, Table, cell_x, cell_y
from swarm_agent.bcmommt.help import choose, issue_calls, keeps, must_go, remember_losses
from swarm_agent.bcmommt.loss import predict_losses
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Answering, Explore, Params
from swarm_agent.bcmommt.reach import time_to_capture
from swarm_agent.bcmommt.tags import claim_tags


class Mind(NamedTuple):
    """What an agent carries from tick to tick beside its table.

    Attributes:
        mode: follow, help or explore. helping: the target whose call it answers, or NOBODY.
        capture_s: its time to capture that target, as broadcast (whole milliseconds).
        heading_x, heading_y: unit vector of the persistent walk.
        goal: the cell it explores next, or NOBODY, chosen at goal_since_s.
    """

    mode: Mode
    helping: int
    capture_s: float
    heading_x: float
    heading_y: float
    goal: int
    goal_since_s: float


def new_mind(heading_x: float, heading_y: float) -> Mind:
    """A robot begins in Explore, walking along (heading_x, heading_y)."""
    return Mind(Mode.EXPLORE, NOBODY, FAR, heading_x, heading_y, NOBODY, NEVER)


def decide(
    t: Table, p: Params, mind: Mind, me: int, x: float, y: float, now: float, seed: int, tick: int
) -> tuple[Mind, float, float]:
    """What agent `me` at (x, y) does now, the table being up to date. Fills the columns tagged, calling and loss_in_s.

    Args:
        now: the clock that all instants in the table are read from, s. seed, tick: the keys of chance.

    Returns:
        The next mind, and the wanted velocity (east, north) in m/s.
    """
    if p.explore == Explore.STALE_FIRST:
        look_around(t, p, x, y, now)
    remember_losses(t, p, x, y, now)
    helping = still_helping(t, p, mind, me, x, y, now)
    n_tags = claim_tags(t, p, me, helping, now)
    predict_losses(t, p, n_tags)
    issue_calls(t, p, now)

    if n_tags > 0:
        vx, vy = follow(t, p, x, y)
        return next_mind(mind, Mode.FOLLOW, NOBODY, FAR), vx, vy

    capture = FAR
    if helping != NOBODY and (p.commitment or p.answering == Answering.OPTIMAL):
        capture = time_to_capture(t, p, helping, x, y, now)
    if capture >= FAR:  # free to choose, or its target has outrun it
        helping, capture = choose(t, p, me, x, y, helping, mind.capture_s, now)
    if helping == NOBODY:
        return explore(t, p, next_mind(mind, Mode.EXPLORE, NOBODY, FAR), me, x, y, now, seed, tick)
    mind = next_mind(mind, Mode.HELP, helping, on_wire(capture))
    if must_go(t, p, helping, capture, now):
        vx, vy = approach(t, p, helping, x, y, now)
        return mind, vx, vy
    return explore(t, p, mind, me, x, y, now, seed, tick)


def still_helping(t: Table, p: Params, mind: Mind, me: int, x: float, y: float, now: float) -> int:
    """The call that the agent stays committed to, or NOBODY."""
    if mind.helping != NOBODY and keeps(t, p, mind.helping, me, x, y, mind.capture_s, now):
        return mind.helping
    return NOBODY


def next_mind(mind: Mind, mode: Mode, helping: int, capture_s: float) -> Mind:
    """The same walk and goal in another mode."""
    return Mind(mode, helping, capture_s, mind.heading_x, mind.heading_y, mind.goal, mind.goal_since_s)


def explore(
    t: Table, p: Params, mind: Mind, me: int, x: float, y: float, now: float, seed: int, tick: int
) -> tuple[Mind, float, float]:
    """The search at full speed, as `p.explore` says: the next mind, with the mode it came in, and the velocity."""
    hx, hy, goal, since = mind.heading_x, mind.heading_y, mind.goal, mind.goal_since_s
    if p.explore == Explore.STALE_FIRST and is_seen_since(t, goal, since):
        goal, since = stalest_cell(t, p, x, y, now), now
    if goal != NOBODY:
        dx, dy = cell_x(p, goal) - x, cell_y(p, goal) - y
        distance = sqrt(dx * dx + dy * dy)
        if distance > 1e-6:  # else right above its center: straight on
            hx, hy = dx / distance, dy / distance
    else:
        hx, hy = walk(t, p, hx, hy, me, x, y, now, seed, tick)
    mind = Mind(mind.mode, mind.helping, mind.capture_s, hx, hy, goal, since)
    return mind, hx * p.agent_speed_m_s, hy * p.agent_speed_m_s
