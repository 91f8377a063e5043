"""One mission with ideal vehicles and an ideal radio, compiled: the tick of `missions.flight` without its wires.

What the wires would round is rounded here the same way: velocities and positions pass through MAVLink's 32-bit floats,
what agents tell each other through whole millimeters and milliseconds.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from comms.link import in_range
from comms.messages import MAX_CALLS, MAX_TAGS, on_wire
from missions.metrics import CALL_PAUSE_S
from missions.study.rules import compiled, inlined
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
from swarm_agent.bcmommt.params import Params, with_range
from swarm_agent.bcmommt.step import Mind
from swarm_agent.policies.choice import decide
from vehicle_sim.sensing import facing, reported, sees
from vehicle_sim.targets import evade, roam

EVASIVE, RANDOM, STATIC, REPLAY = 0, 1, 2, 3

Array = Any


class Setup(NamedTuple):
    """What one mission starts from. m agents, n targets, T ticks; positions in ENU meters.

    Attributes:
        home_x, home_y (m): agents' starting places. heading_x, heading_y (m): unit vectors of their search.
        target_x, target_y, target_ux, target_uy (n): targets' places and headings.
        track_x, track_y (T, n): places of replayed targets, NaN while absent; (0, 0) for other motions.
        sensing_range_m (m): how far each agent sees; cos_half_opening: and into which angle, as `sees` reads it.
        motion: EVASIVE, RANDOM, STATIC or REPLAY. start_tick: the clock's tick at which the mission begins.
    """

    home_x: Array
    home_y: Array
    heading_x: Array
    heading_y: Array
    target_x: Array
    target_y: Array
    target_ux: Array
    target_uy: Array
    track_x: Array
    track_y: Array
    motion: int
    target_speed_m_s: float
    notice_range_m: float
    comm_range_m: float
    sensing_range_m: Array
    cos_half_opening: float
    identity_error: float
    seed: int
    ticks: int
    start_tick: int


class Said(NamedTuple):
    """The frames of one tick, by sender: counts, and columns of their tags, calls and answer."""

    x: Array
    y: Array
    n_tags: Array
    tag: Array  # (m, n) target ids
    tag_values: Array  # (m, n, 5): x, y, vx, vy, distance
    n_calls: Array
    call: Array
    call_values: Array  # (m, n, 6): x, y, vx, vy, loss in, seen ago
    answer: Array
    capture: Array


class Flock(NamedTuple):
    """What changes from tick to tick beside the tables: minds and places of agents, places of targets.

    Attributes:
        mode .. goal_since (m): the columns of every agent's `Mind`. east, north (m): true place from home; x, y (m): in
        the mission's frame, and before_x, before_y one tick ago. facing_x, facing_y (m): unit vector it looks along.
        v_east, v_north (m): velocity to the next tick.
        target_x .. target_uy (n), here (n): targets, and whether they are in the world. seen (n): whether any sensor
        sees them, under whatever name.
        owned (m, n), helping (m): tags and help one tick ago. called_at (m, n): when each call was last out.
        heard (m): scratch.
    """

    mode: Array
    helps: Array
    capture: Array
    heading_x: Array
    heading_y: Array
    goal: Array
    goal_since: Array
    east: Array
    north: Array
    x: Array
    y: Array
    facing_x: Array
    facing_y: Array
    before_x: Array
    before_y: Array
    v_east: Array
    v_north: Array
    target_x: Array
    target_y: Array
    target_ux: Array
    target_uy: Array
    here: Array
    seen: Array
    owned: Array
    helping: Array
    called_at: Array
    heard: Array


class Kept(NamedTuple):
    """What is kept of a mission. The last five are empty unless everything is kept."""

    seen: Array  # (T)
    present: Array  # (T)
    events: Array  # (3)
    help: Array  # (4)
    agents: Array  # (T, m, 2)
    targets: Array  # (T, n, 2)
    tagged: Array  # (T, m, n)
    sensed: Array  # (T, m, n)
    mode: Array  # (T, m)


@inlined
def _row(t: Table, i: int) -> Table:
    """Agent i's table: one row of every column."""
    return Table(
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
def _count(kept: Kept, tables: Table, f: Flock, said: Said, k: int, now: float) -> None:
    """Coverage, definition 7 and help episodes of tick k, as `missions.metrics` counts them."""
    m, n = f.owned.shape
    for j in range(n):
        had = has = dropped = False
        for i in range(m):
            had |= f.owned[i, j]
            has |= tables.tagged[i, j]
            dropped |= f.owned[i, j] and not tables.tagged[i, j]
        kept.present[k] += f.here[j]
        kept.seen[k] += f.seen[j]
        kept.events[0] += had and not has
        kept.events[1] += has and not had
        kept.events[2] += had and has and dropped
    for i in range(m):
        for c in range(said.n_calls[i]):
            j = said.call[i, c]
            kept.help[0] += now - f.called_at[i, j] > CALL_PAUSE_S
            f.called_at[i, j] = now
        old, new = f.helping[i], said.answer[i]
        if new != old:
            kept.help[1] += new != NOBODY
            if old != NOBODY:
                if tables.tagged[i, old]:
                    kept.help[2] += 1
                else:
                    kept.help[3] += _is_answered(said, old)
    for i in range(m):
        f.helping[i] = said.answer[i]
        for j in range(n):
            f.owned[i, j] = tables.tagged[i, j]


@inlined
def _is_answered(said: Said, j: int) -> bool:
    for i in range(len(said.answer)):  # noqa: SIM110  # a generator does not compile
        if said.answer[i] == j:
            return True
    return False


@inlined
def _act(s: Setup, p: Params, t: Table, f: Flock, old: Said, new: Said, i: int, k: int) -> None:
    """Agent i at tick k: hear, see, decide, say."""
    now, said_at = (s.start_tick + k) * p.tick_s, on_wire((s.start_tick + k - 1) * p.tick_s)
    # Where the agent believes it is: its local position comes as a 32-bit float.
    x = s.home_x[i] + np.float64(np.float32(f.east[i]))
    y = s.home_y[i] + np.float64(np.float32(f.north[i]))
    begin_tick(t)
    if k > 0:
        for q in range(len(f.x)):
            f.heard[q] = q != i and in_range(
                f.before_x[i] - f.before_x[q], f.before_y[i] - f.before_y[q], s.comm_range_m
            )
            if f.heard[q]:
                hear_mate(t, q, old.x[q], old.y[q], said_at)
        for q in range(len(f.x)):
            if f.heard[q]:
                _hear(t, p, old, q, said_at)
    ux, uy = facing(f.facing_x[i], f.facing_y[i], f.v_east[i], f.v_north[i])
    f.facing_x[i], f.facing_y[i] = ux, uy
    for j in range(len(f.here)):
        dx, dy = f.target_x[j] - f.x[i], f.target_y[j] - f.y[i]
        if f.here[j] and sees(dx, dy, p.sensing_range_m, ux, uy, s.cos_half_opening):
            f.seen[j] = True
            name = reported(j, len(f.here), s.identity_error, i, s.seed, k)
            see(t, p, name, f.target_x[j], f.target_y[j], x, y, now)
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
    for j in range(len(f.here)):
        if s.motion == EVASIVE:
            f.target_x[j], f.target_y[j], f.target_ux[j], f.target_uy[j] = evade(
                p.arena, f.target_x[j], f.target_y[j], f.target_ux[j], f.target_uy[j], f.x, f.y,
                s.notice_range_m, s.target_speed_m_s, p.tick_s, s.seed, k, j,
            )  # fmt: skip
        elif s.motion == RANDOM:
            f.target_x[j], f.target_y[j], f.target_ux[j], f.target_uy[j] = roam(
                p.arena, f.target_x[j], f.target_y[j], f.target_ux[j], f.target_uy[j],
                s.target_speed_m_s, p.tick_s, s.seed, k, j,
            )  # fmt: skip
    dt = (s.start_tick + k + 1) * p.tick_s - (s.start_tick + k) * p.tick_s
    for i in range(len(f.x)):
        f.before_x[i], f.before_y[i] = f.x[i], f.y[i]
        f.east[i] += f.v_east[i] * dt
        f.north[i] += f.v_north[i] * dt
        f.x[i] = s.home_x[i] + f.east[i]
        f.y[i] = s.home_y[i] + f.north[i]


@inlined
def _keep(kept: Kept, tables: Table, f: Flock, k: int) -> None:
    m, n = f.owned.shape
    for i in range(m):
        kept.agents[k, i, 0], kept.agents[k, i, 1] = f.x[i], f.y[i]
        kept.mode[k, i] = f.mode[i]
        for j in range(n):
            kept.tagged[k, i, j] = tables.tagged[i, j]
            kept.sensed[k, i, j] = tables.sensed[i, j]
    for j in range(n):
        kept.targets[k, j, 0], kept.targets[k, j, 1] = f.target_x[j], f.target_y[j]


@compiled
def fly(s: Setup, p: Params, tables: Table, f: Flock, odd: Said, even: Said, kept: Kept) -> None:
    """Fly one mission. `tables` holds every agent's table as a row. All arrays but `s` are written to.

    Nothing in here allocates or counts references (see `rules.OPTIONS`): all arrays come from the caller.
    """
    for k in range(s.ticks):
        if s.motion == REPLAY:
            for j in range(len(f.here)):
                f.here[j] = s.track_x[k, j] == s.track_x[k, j]  # NaN while it is absent
                f.target_x[j], f.target_y[j] = s.track_x[k, j], s.track_y[k, j]
        for j in range(len(f.seen)):
            f.seen[j] = False
        for i in range(len(f.x)):
            own = with_range(p, s.sensing_range_m[i])
            if k % 2 == 0:
                _act(s, own, _row(tables, i), f, odd, even, i, k)
            else:
                _act(s, own, _row(tables, i), f, even, odd, i, k)
        now = (s.start_tick + k) * p.tick_s
        _count(kept, tables, f, even if k % 2 == 0 else odd, k, now)
        if len(kept.agents) > 0:
            _keep(kept, tables, f, k)
        _move(s, p, f, k)
