"""How the targets of a compiled mission move: the rules of `vehicle_sim.targets`, or the tracks they replay."""

from __future__ import annotations

from missions.study.compiled.rules import inlined
from missions.study.compiled.state import EVASIVE, RANDOM, Array, Setup
from swarm_agent.bcmommt.params import Params
from vehicle_sim.targets import evade, roam


@inlined
def move_targets(
    s: Setup, p: Params, x: Array, y: Array, ux: Array, uy: Array, agents_x: Array, agents_y: Array, k: int
) -> None:
    """Targets at (x, y) with headings (ux, uy) move from state k to k + 1, given where agents are at k."""
    for j in range(len(x)):
        if s.motion == EVASIVE:
            x[j], y[j], ux[j], uy[j] = evade(
                p.arena, x[j], y[j], ux[j], uy[j], agents_x, agents_y,
                s.notice_range_m, s.target_speed_m_s, p.tick_s, s.seed, k, j,
            )  # fmt: skip
        elif s.motion == RANDOM:
            x[j], y[j], ux[j], uy[j] = roam(
                p.arena, x[j], y[j], ux[j], uy[j], s.target_speed_m_s, p.tick_s, s.seed, k, j
            )


@inlined
def place_replayed(s: Setup, here: Array, x: Array, y: Array, k: int) -> None:
    """Replayed targets are where their tracks say at tick k, or not in the world."""
    for j in range(len(x)):
        here[j] = s.track_x[k, j] == s.track_x[k, j]  # NaN while it is absent
        x[j], y[j] = s.track_x[k, j], s.track_y[k, j]
