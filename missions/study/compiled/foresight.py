"""The perfect predictor, which only a study can have: when each target will be lost if nobody helps.

Theorem 2 assumes it (definition 6). A copy of the world is rolled forward in which tags are definition 3's at every
instant, every agent follows the center of gravity of its tags, idle agents fly straight on, and targets move as they
will, chance included.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from comms.arena import clamped
from missions.study.compiled.motion import move_targets, place_replayed
from missions.study.compiled.rules import called, inlined
from missions.study.compiled.state import REPLAY, Array, Flock, Setup
from swarm_agent.bcmommt.behaviors import pursue
from swarm_agent.bcmommt.belief import FAR, NOBODY, Table
from swarm_agent.bcmommt.params import Params
from vehicle_sim.sensing import facing, sees


class Future(NamedTuple):
    """The copy of the world: m agents, n targets; meters, meters a second, the mission's frame.

    Attributes:
        x, y, vx, vy, facing_x, facing_y (m): agents. here, target_x .. target_uy (n): targets; was_x, was_y (n): one
        step ago. owner (n): definition 3's, or NOBODY. sum_x .. sum_vy, n_tags (m): of each agent's tags.
        loss_in_s (n): what came of it: until the target is out of everybody's sight; FAR if beyond the horizon.
    """

    x: Array
    y: Array
    vx: Array
    vy: Array
    facing_x: Array
    facing_y: Array
    here: Array
    target_x: Array
    target_y: Array
    target_ux: Array
    target_uy: Array
    was_x: Array
    was_y: Array
    owner: Array
    sum_x: Array
    sum_y: Array
    sum_vx: Array
    sum_vy: Array
    n_tags: Array
    loss_in_s: Array


def new_future(m: int, n: int) -> Future:
    """Room for it."""
    agents = {name: np.zeros(m) for name in ("x", "y", "vx", "vy", "facing_x", "facing_y")}
    sums = {name: np.zeros(m) for name in ("sum_x", "sum_y", "sum_vx", "sum_vy")}
    places = ("target_x", "target_y", "target_ux", "target_uy", "was_x", "was_y", "loss_in_s")
    return Future(
        **agents,
        here=np.zeros(n, np.bool_),
        **{name: np.zeros(n) for name in places},
        owner=np.zeros(n, np.int64),
        **sums,
        n_tags=np.zeros(m, np.int64),
    )


@called
def foresee(s: Setup, p: Params, f: Flock, tables: Table, w: Future, k: int) -> None:
    """Fill `loss_in_s` of every agent's table from the true state at tick k."""
    _copy(s, p, f, w)
    _own(s, w)
    for j in range(len(w.owner)):
        w.loss_in_s[j] = FAR
    if _anybody_has_two(w):  # nobody else loses a target, nor asks
        steps = int(p.horizon_s / p.tick_s + 0.5)
        for step in range(1, steps + 1):
            if s.motion == REPLAY and k + step >= s.ticks:
                break
            _step(s, p, w, k + step - 1)
            _own(s, w)
            for j in range(len(w.owner)):
                if w.owner[j] == NOBODY and w.loss_in_s[j] == FAR:
                    w.loss_in_s[j] = step * p.tick_s
    m, n = tables.loss_in_s.shape
    for i in range(m):
        for j in range(n):
            tables.loss_in_s[i, j] = w.loss_in_s[j]


@inlined
def _copy(s: Setup, p: Params, f: Flock, w: Future) -> None:
    for i in range(len(w.x)):
        w.x[i], w.y[i], w.vx[i], w.vy[i] = f.x[i], f.y[i], f.v_east[i], f.v_north[i]
        w.facing_x[i], w.facing_y[i] = f.facing_x[i], f.facing_y[i]
    speed = s.target_speed_m_s * p.tick_s
    for j in range(len(w.here)):
        w.here[j] = f.here[j]
        w.target_x[j], w.target_y[j] = f.target_x[j], f.target_y[j]
        w.target_ux[j], w.target_uy[j] = f.target_ux[j], f.target_uy[j]
        w.was_x[j], w.was_y[j] = f.target_x[j] - speed * f.target_ux[j], f.target_y[j] - speed * f.target_uy[j]


@inlined
def _own(s: Setup, w: Future) -> None:
    """Definition 3: of all agents that see a target the nearest tags it (equal distances: the lower id)."""
    for i in range(len(w.n_tags)):
        w.n_tags[i] = 0
    for j in range(len(w.owner)):
        w.owner[j] = NOBODY
        nearest = FAR
        for i in range(len(w.x)):
            dx, dy = w.target_x[j] - w.x[i], w.target_y[j] - w.y[i]
            squared = dx * dx + dy * dy
            if (
                w.here[j]
                and squared < nearest
                and sees(dx, dy, s.sensing_range_m[i], w.facing_x[i], w.facing_y[i], s.cos_half_opening)
            ):
                w.owner[j], nearest = i, squared
        if w.owner[j] != NOBODY:
            w.n_tags[w.owner[j]] += 1


@inlined
def _anybody_has_two(w: Future) -> bool:
    for i in range(len(w.n_tags)):  # noqa: SIM110  # a generator does not compile
        if w.n_tags[i] > 1:
            return True
    return False


@inlined
def _step(s: Setup, p: Params, w: Future, k: int) -> None:
    """From state k to k + 1: agents steer by the tags in `owner`."""
    for i in range(len(w.x)):
        w.sum_x[i] = w.sum_y[i] = w.sum_vx[i] = w.sum_vy[i] = 0.0
    for j in range(len(w.owner)):
        i = w.owner[j]
        if i != NOBODY:
            w.sum_x[i] += w.target_x[j]
            w.sum_y[i] += w.target_y[j]
            w.sum_vx[i] += (w.target_x[j] - w.was_x[j]) / p.tick_s
            w.sum_vy[i] += (w.target_y[j] - w.was_y[j]) / p.tick_s
        w.was_x[j], w.was_y[j] = w.target_x[j], w.target_y[j]
    for i in range(len(w.x)):
        n = w.n_tags[i]
        if n > 0:
            w.vx[i], w.vy[i] = pursue(
                p, w.sum_x[i] / n - w.x[i], w.sum_y[i] / n - w.y[i], w.sum_vx[i] / n, w.sum_vy[i] / n
            )
    move_targets(s, p, w.target_x, w.target_y, w.target_ux, w.target_uy, w.x, w.y, k)
    if s.motion == REPLAY:
        place_replayed(s, w.here, w.target_x, w.target_y, k + 1)
    for i in range(len(w.x)):
        w.x[i], w.y[i] = clamped(p.arena, w.x[i] + w.vx[i] * p.tick_s, w.y[i] + w.vy[i] * p.tick_s)
        w.facing_x[i], w.facing_y[i] = facing(w.facing_x[i], w.facing_y[i], w.vx[i], w.vy[i])
