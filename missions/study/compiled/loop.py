"""One mission with ideal vehicles and an ideal radio, compiled: the tick of `missions.flight` without its wires.

What the wires would round is rounded here the same way: velocities and positions pass through MAVLink's 32-bit floats,
what agents tell each other through whole millimeters and milliseconds.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from comms.link import in_range
from comms.messages import MAX_CALLS, MAX_TAGS, on_wire
from missions.study.compiled.counting import count, keep_all
from missions.study.compiled.foresight import Future, foresee, new_future
from missions.study.compiled.motion import move_targets, place_replayed
from missions.study.compiled.referee import Desk, assign, new_desk
from missions.study.compiled.rows import row
from missions.study.compiled.rules import compiled, inlined
from missions.study.compiled.state import REPLAY, Flock, Kept, Said, Setup
from swarm_agent.bcmommt.belief import (
    NOBODY,
    Table,
    begin_tick,
    hear_answer,
    hear_call,
    hear_mate,
    hear_position,
    hear_tag,
    see,
)
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Answering, Params, Predictor, with_range
from swarm_agent.bcmommt.step import Mind
from swarm_agent.policies.choice import decide
from vehicle_sim.sensing import facing, reported, sees


@inlined
def _hear(t: Table, p: Params, said: Said, q: int, at: float) -> None:
    """Enter what agent q says into a table, as `speech.hear` does."""
    for k in range(said.n_tags[q]):
        j, v = said.tag[q, k], said.tag_values
        hear_position(t, j, v[q, k, 0], v[q, k, 1], v[q, k, 2], v[q, k, 3], at)
        hear_tag(t, p, j, q, v[q, k, 4], at)
    for k in range(said.n_calls[q]):
        j, v = said.call[q, k], said.call_values
        hear_position(t, j, v[q, k, 0], v[q, k, 1], v[q, k, 2], v[q, k, 3], at - v[q, k, 5])
        hear_call(t, p, j, q, at + v[q, k, 4], at)
    if said.answer[q] != NOBODY:
        hear_answer(t, p, said.answer[q], q, said.capture[q], at)


@inlined
def _say(said: Said, t: Table, p: Params, i: int, x: float, y: float, now: float) -> None:
    """What agent i broadcasts, as it reads after the wire: `speech.tags_said` and `calls_said`."""
    said.x[i], said.y[i] = on_wire(x), on_wire(y)
    n_tags = n_calls = 0
    for j in range(len(t.tagged)):
        if t.tagged[j] and n_tags < MAX_TAGS:
            said.tag[i, n_tags] = j
            v = said.tag_values[i, n_tags]
            v[0], v[1] = on_wire(t.x_m[j]), on_wire(t.y_m[j])
            v[2], v[3], v[4] = on_wire(t.vx_m_s[j]), on_wire(t.vy_m_s[j]), on_wire(t.distance_m[j])
            n_tags += 1
        if t.calling[j] and n_calls < MAX_CALLS:
            said.call[i, n_calls] = j
            v = said.call_values[i, n_calls]
            v[0], v[1] = on_wire(t.x_m[j]), on_wire(t.y_m[j])
            v[2], v[3] = on_wire(t.vx_m_s[j]), on_wire(t.vy_m_s[j])
            v[4] = on_wire(min(t.loss_in_s[j], p.horizon_s)) if t.tagged[j] else 0.0
            v[5] = on_wire(now - t.known_at_s[j])
            n_calls += 1
    said.n_tags[i], said.n_calls[i] = n_tags, n_calls


@inlined
def _link(s: Setup, f: Flock) -> None:
    """Who hears whom: the frames of one tick ago reach those who were in range then. Range has no direction."""
    for i in range(len(f.x)):
        for q in range(i):
            near = in_range(f.before_x[i] - f.before_x[q], f.before_y[i] - f.before_y[q], s.comm_range_m)
            f.linked[i, q] = f.linked[q, i] = near


@inlined
def _perceive(s: Setup, p: Params, t: Table, f: Flock, old: Said, i: int, k: int) -> None:
    """Agent i at tick k: where it believes it is, what it hears and what it sees."""
    # Its local position comes as a 32-bit float.
    f.me_x[i] = s.home_x[i] + np.float64(np.float32(f.east[i]))
    f.me_y[i] = s.home_y[i] + np.float64(np.float32(f.north[i]))
    begin_tick(t)
    if k > 0:
        said_at = on_wire((s.start_tick + k - 1) * p.tick_s)
        for q in range(len(f.x)):
            if f.linked[i, q]:
                hear_mate(t, q, old.x[q], old.y[q], said_at)
        for q in range(len(f.x)):
            if f.linked[i, q]:
                _hear(t, p, old, q, said_at)
    ux, uy = facing(f.facing_x[i], f.facing_y[i], f.v_east[i], f.v_north[i])
    f.facing_x[i], f.facing_y[i] = ux, uy
    for j in range(len(f.here)):
        dx, dy = f.target_x[j] - f.x[i], f.target_y[j] - f.y[i]
        if f.here[j] and sees(dx, dy, p.sensing_range_m, ux, uy, s.cos_half_opening):
            f.seen[j] = True
            name = reported(j, len(f.here), s.identity_error, i, s.seed, k)
            see(t, p, name, f.target_x[j], f.target_y[j], f.me_x[i], f.me_y[i], (s.start_tick + k) * p.tick_s)


@inlined
def _act(s: Setup, p: Params, t: Table, f: Flock, new: Said, i: int, k: int) -> None:
    """Agent i at tick k: decide, and say."""
    now, x, y = (s.start_tick + k) * p.tick_s, f.me_x[i], f.me_y[i]
    mode = Mode.EXPLORE if f.mode[i] == 0 else (Mode.FOLLOW if f.mode[i] == 1 else Mode.HELP)
    mind = Mind(mode, f.helps[i], f.capture[i], f.heading_x[i], f.heading_y[i], f.goal[i], f.goal_since[i])
    mind, vx, vy = decide(t, p, mind, i, x, y, now, s.seed, k)
    f.mode[i], f.helps[i], f.capture[i] = mind.mode, mind.helping, mind.capture_s
    f.heading_x[i], f.heading_y[i] = mind.heading_x, mind.heading_y
    f.goal[i], f.goal_since[i] = mind.goal, mind.goal_since_s
    f.v_east[i], f.v_north[i] = np.float64(np.float32(vx)), np.float64(np.float32(vy))
    _say(new, t, p, i, x, y, now)
    new.answer[i] = mind.helping if mind.mode == Mode.HELP else NOBODY
    new.capture[i] = mind.capture_s


@inlined
def _move(s: Setup, p: Params, f: Flock, k: int) -> None:
    """Targets decide from where agents are now; then everything moves on to tick k + 1."""
    move_targets(s, p, f.target_x, f.target_y, f.target_ux, f.target_uy, f.x, f.y, k)
    dt = (s.start_tick + k + 1) * p.tick_s - (s.start_tick + k) * p.tick_s
    for i in range(len(f.x)):
        f.before_x[i], f.before_y[i] = f.x[i], f.y[i]
        f.east[i] += f.v_east[i] * dt
        f.north[i] += f.v_north[i] * dt
        f.x[i] = s.home_x[i] + f.east[i]
        f.y[i] = s.home_y[i] + f.north[i]


class Oracle(NamedTuple):
    """What only a study can know: what will happen (`foresight`), and what everybody hears (`referee`)."""

    future: Future
    desk: Desk


def new_oracle(m: int, n: int) -> Oracle:
    """One that has not been asked."""
    return Oracle(new_future(m, n), new_desk(m, n))


@compiled
def fly(s: Setup, p: Params, tables: Table, f: Flock, odd: Said, even: Said, kept: Kept, oracle: Oracle | None) -> None:
    """Fly one mission. `tables` holds every agent's table as a row. All arrays but `s` are written to.

    Nothing in here allocates or counts references (see `rules.OPTIONS`): all arrays come from the caller. Without an
    oracle its branches are not compiled: even unused they would cost a tenth of the speed.
    """
    for k in range(s.ticks):
        old, new = (odd, even) if k % 2 == 0 else (even, odd)
        if s.motion == REPLAY:
            place_replayed(s, f.here, f.target_x, f.target_y, k)
        for j in range(len(f.seen)):
            f.seen[j] = False
        _link(s, f)
        for i in range(len(f.x)):
            own, t = with_range(p, s.sensing_range_m[i]), row(tables, i)
            _perceive(s, own, t, f, old, i, k)
            if oracle is None:
                _act(s, own, t, f, new, i, k)
        if oracle is not None:  # it speaks when everybody has perceived
            if p.predictor == Predictor.PERFECT:
                foresee(s, p, f, tables, oracle.future, k)
            if p.answering == Answering.OPTIMAL and k > 0:
                assign(s, p, f, tables, old, oracle.desk, k)
            for i in range(len(f.x)):
                _act(s, with_range(p, s.sensing_range_m[i]), row(tables, i), f, new, i, k)
        count(kept, tables, f, new, k, (s.start_tick + k) * p.tick_s)
        if len(kept.agents) > 0:
            keep_all(kept, tables, f, k)
        _move(s, p, f, k)
