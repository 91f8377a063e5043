"""Small hand-made situations for the rules: parameters of the paper's world, and a table filled in a line."""

from __future__ import annotations

from typing import Any

from comms.arena import disc
from swarm_agent.bcmommt.belief import Table, begin_tick, hear_call, hear_position, hear_tag, new_table, see
from swarm_agent.bcmommt.params import Call, Capture, Explore, Gate, Params, Predictor

PAPER_WORLD = Params(
    arena=disc(30.0),
    tick_s=0.1,
    sensing_range_m=5.5,
    agent_speed_m_s=0.4,
    target_speed_m_s=0.3,
    standoff_m=0.0,
    turn_time_s=0.5,
    horizon_s=20.0,
    help_margin_s=2.0,
    tag_lease_s=0.5,
    help_lease_s=1.0,
    memory_s=0.0,
    follow_gain_per_s=1.0,
    predictor=Predictor.DIRECT,
    call=Call.PREDICTED,
    gate=Gate.IN_TIME,
    capture=Capture.WORST_CASE,
    commitment=True,
    explore=Explore.PERSISTENT_WALK,
)
NOW = 10.0
LAST_TICK = 9.9


def params(**changes: Any) -> Params:
    return PAPER_WORLD._replace(**changes)


def table(n_targets: int = 4, n_agents: int = 5, n_cells: int = 0) -> Table:
    return new_table(n_targets, n_agents, n_cells)


def sense(t: Table, j: int, x: float, y: float, vx: float = 0.0, vy: float = 0.0) -> None:
    """Target j has been in sight of an agent at the origin for two ticks, moving at (vx, vy)."""
    assert t.known_at_s[j] <= LAST_TICK
    see(t, PAPER_WORLD, j, x - 0.1 * vx, y - 0.1 * vy, 0.0, 0.0, LAST_TICK)
    see(t, PAPER_WORLD, j, x, y, 0.0, 0.0, NOW)
    t.distance_before_m[j] = t.distance_m[j]


def claim(t: Table, j: int, mate: int, distance: float, at: float = LAST_TICK) -> None:
    hear_tag(t, PAPER_WORLD, j, mate, distance, at)


def call(t: Table, j: int, mate: int, x: float, y: float, loss_in: float = 10.0, at: float = LAST_TICK) -> None:
    """A mate follows target j at (x, y), and will lose it in `loss_in` from now."""
    hear_position(t, j, x, y, 0.0, 0.0, at)
    hear_tag(t, PAPER_WORLD, j, mate, 3.0, at)
    hear_call(t, PAPER_WORLD, j, mate, NOW + loss_in, at)


__all__ = ["LAST_TICK", "NOW", "PAPER_WORLD", "begin_tick", "call", "claim", "params", "sense", "table"]
