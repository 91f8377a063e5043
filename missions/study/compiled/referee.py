"""The optimal answering of help calls, which only a study can have: a referee hears all calls, and sends idle agents.

The paper's "centralized and optimal version": H holds the time to capture of every idle agent on every call (eq. 15),
and the assignment is the one of the linear bottleneck problem.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from comms.messages import on_wire
from missions.study.compiled.bottleneck import match_bottleneck
from missions.study.compiled.rows import row
from missions.study.compiled.rules import called, inlined
from missions.study.compiled.state import Array, Flock, Said, Setup
from swarm_agent.bcmommt.belief import FAR, NOBODY, Table, hear_call, hear_position
from swarm_agent.bcmommt.help import is_called, time_if_answered
from swarm_agent.bcmommt.params import Params, with_range


class Desk(NamedTuple):
    """What the referee works on: m agents, n targets.

    Attributes:
        capture_s (m, n): H, FAR where an agent is busy, or cannot help. call_of (m), agent_of (n): the assignment, or
        NOBODY. came_from (n), queue (m): scratch of the matching.
    """

    capture_s: Array
    call_of: Array
    agent_of: Array
    came_from: Array
    queue: Array


def new_desk(m: int, n: int) -> Desk:
    """An empty desk."""
    return Desk(
        capture_s=np.full((m, n), FAR),
        call_of=np.full(m, NOBODY),
        agent_of=np.full(n, NOBODY),
        came_from=np.full(n, NOBODY),
        queue=np.zeros(m, np.int64),
    )


@called
def assign(s: Setup, p: Params, f: Flock, tables: Table, said: Said, d: Desk, k: int) -> None:
    """Set `f.helps` of every idle agent from the frames of one tick ago; who is sent learns all of the call."""
    said_at, now = on_wire((s.start_tick + k - 1) * p.tick_s), (s.start_tick + k) * p.tick_s
    for i in range(len(f.x)):
        t, own = row(tables, i), with_range(p, s.sensing_range_m[i])
        for j in range(len(d.agent_of)):
            d.capture_s[i, j] = FAR
        if said.n_tags[i] == 0:
            for q in range(len(f.x)):
                for c in range(said.n_calls[q]):
                    j, v = said.call[q, c], said.call_values
                    if not _is_followed(said, j, q):
                        hear_position(t, j, v[q, c, 0], v[q, c, 1], v[q, c, 2], v[q, c, 3], said_at - v[q, c, 5])
                        if q != i:
                            hear_call(t, own, j, q, said_at + v[q, c, 4], said_at)
                        if is_called(t, own, j, f.me_x[i], f.me_y[i], now):
                            d.capture_s[i, j] = time_if_answered(t, own, j, f.me_x[i], f.me_y[i], now)
    match_bottleneck(d.capture_s, d.call_of, d.agent_of, d.came_from, d.queue)
    for i in range(len(f.x)):
        f.helps[i] = d.call_of[i]


@inlined
def _is_followed(said: Said, j: int, caller: int) -> bool:
    """Whether somebody other than the caller tags target j: then the call is settled."""
    for q in range(len(said.n_tags)):
        for c in range(said.n_tags[q]):
            if q != caller and said.tag[q, c] == j:
                return True
    return False
