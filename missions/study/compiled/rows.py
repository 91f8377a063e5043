"""One agent's table out of those of all agents."""

from __future__ import annotations

from missions.study.compiled.rules import inlined
from swarm_agent.bcmommt.belief import Table


@inlined
def row(t: Table, i: int) -> Table:
    """Agent i's table: one row of every column. Its rules look at all targets and mates, known or not."""
    m, n = t.sensed.shape
    return Table(
        range(n),
        range(m),
        t.sensed[i],
        t.x_m[i],
        t.y_m[i],
        t.vx_m_s[i],
        t.vy_m_s[i],
        t.known_at_s[i],
        t.distance_m[i],
        t.distance_before_m[i],
        t.tagged[i],
        t.calling[i],
        t.loss_in_s[i],
        t.lost_at_s[i],
        t.owner[i],
        t.owner_distance_m[i],
        t.owner_at_s[i],
        t.caller[i],
        t.call_loss_at_s[i],
        t.caller_at_s[i],
        t.answerer[i],
        t.answer_capture_s[i],
        t.answerer_at_s[i],
        t.mate_x_m[i],
        t.mate_y_m[i],
        t.mate_at_s[i],
        t.cell_seen_at_s[i],
    )
