"""What a compiled mission consists of: where it starts, what changes from tick to tick, what is said, what is kept.

All of it is arrays that the compiled loop is given: it allocates nothing.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from missions.metrics import EVENT_COUNTS, HELP_COUNTS
from swarm_agent.bcmommt.belief import FAR, NEVER, NOBODY, Table

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


def new_said(m: int, n: int) -> Said:
    """Silence."""
    return Said(
        x=np.zeros(m),
        y=np.zeros(m),
        n_tags=np.zeros(m, np.int64),
        tag=np.zeros((m, n), np.int64),
        tag_values=np.zeros((m, n, 5)),
        n_calls=np.zeros(m, np.int64),
        call=np.zeros((m, n), np.int64),
        call_values=np.zeros((m, n, 6)),
        answer=np.full(m, NOBODY),
        capture=np.zeros(m),
    )


class Flock(NamedTuple):
    """What changes from tick to tick beside the tables: minds and places of agents, places of targets.

    Attributes:
        mode .. goal_since (m): the columns of every agent's `Mind`. east, north (m): true place from home. In the
        mission's frame (m): x, y the true place, me_x, me_y where it believes to be, before_x, before_y one tick ago.
        facing_x, facing_y (m): unit vector it looks along.
        v_east, v_north (m): velocity to the next tick.
        target_x .. target_uy (n), here (n): targets, and whether they are in the world. seen (n): whether any sensor
        sees them, under whatever name.
        owned (m, n), helping (m): tags and help one tick ago. pursuing (m): whether it is a target that it lost itself.
        called_at (m, n): when each call was last out.
        linked (m, m): who hears whom; nobody hears itself.
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
    me_x: Array
    me_y: Array
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
    pursuing: Array
    called_at: Array
    linked: Array


def new_flock(setup: Setup) -> Flock:
    """Everybody at the start."""
    m, n = len(setup.home_x), len(setup.target_x)
    return Flock(
        mode=np.zeros(m, np.int64),
        helps=np.full(m, NOBODY),
        capture=np.full(m, FAR),
        heading_x=setup.heading_x.copy(),
        heading_y=setup.heading_y.copy(),
        goal=np.full(m, NOBODY),
        goal_since=np.full(m, NEVER),
        east=np.zeros(m),
        north=np.zeros(m),
        x=setup.home_x.copy(),
        y=setup.home_y.copy(),
        facing_x=setup.heading_x.copy(),
        facing_y=setup.heading_y.copy(),
        me_x=np.zeros(m),
        me_y=np.zeros(m),
        before_x=np.zeros(m),
        before_y=np.zeros(m),
        v_east=np.zeros(m),
        v_north=np.zeros(m),
        target_x=setup.target_x.copy(),
        target_y=setup.target_y.copy(),
        target_ux=setup.target_ux.copy(),
        target_uy=setup.target_uy.copy(),
        here=np.ones(n, np.bool_),
        seen=np.zeros(n, np.bool_),
        owned=np.zeros((m, n), np.bool_),
        helping=np.full(m, NOBODY),
        pursuing=np.zeros(m, np.bool_),
        called_at=np.full((m, n), NEVER),
        linked=np.zeros((m, m), np.bool_),
    )


class Kept(NamedTuple):
    """What is kept of a mission. The last five are empty unless everything is kept."""

    seen: Array  # (T)
    present: Array  # (T)
    events: Array  # (3): `missions.metrics.EVENT_COUNTS`
    help: Array  # (6): HELP_COUNTS
    agents: Array  # (T, m, 2)
    targets: Array  # (T, n, 2)
    tagged: Array  # (T, m, n)
    sensed: Array  # (T, m, n)
    mode: Array  # (T, m)


def new_kept(ticks: int, m: int, n: int, keep_all: bool) -> Kept:
    """Room for a mission: for the counts alone, or for everything."""
    more = ticks if keep_all else 0
    return Kept(
        seen=np.zeros(ticks, np.int32),
        present=np.zeros(ticks, np.int32),
        events=np.zeros(len(EVENT_COUNTS), np.int64),
        help=np.zeros(len(HELP_COUNTS), np.int64),
        agents=np.zeros((more, m, 2)),
        targets=np.zeros((more, n, 2)),
        tagged=np.zeros((more, m, n), np.bool_),
        sensed=np.zeros((more, m, n), np.bool_),
        mode=np.zeros((more, m), np.int8),
    )


def new_tables(m: int, n: int, cells: int) -> Table:
    """A row for every agent, who knows nothing yet, in every column of `Table`."""

    def per_target(value: float, dtype: Any = np.float64) -> npt.NDArray[Any]:
        return np.full((m, n), value, dtype)

    return Table(
        known=(),
        mates=(),
        sensed=per_target(False, np.bool_),
        x_m=per_target(0.0),
        y_m=per_target(0.0),
        vx_m_s=per_target(0.0),
        vy_m_s=per_target(0.0),
        known_at_s=per_target(NEVER),
        distance_m=per_target(FAR),
        distance_before_m=per_target(FAR),
        tagged=per_target(False, np.bool_),
        calling=per_target(False, np.bool_),
        loss_in_s=per_target(FAR),
        lost_at_s=per_target(NEVER),
        owner=per_target(NOBODY, np.int64),
        owner_distance_m=per_target(FAR),
        owner_at_s=per_target(NEVER),
        caller=per_target(NOBODY, np.int64),
        call_loss_at_s=per_target(NEVER),
        caller_at_s=per_target(NEVER),
        answerer=per_target(NOBODY, np.int64),
        answer_capture_s=per_target(FAR),
        answerer_at_s=per_target(NEVER),
        mate_x_m=np.zeros((m, m)),
        mate_y_m=np.zeros((m, m)),
        mate_at_s=np.full((m, m), NEVER),
        cell_seen_at_s=np.full((m, cells), NEVER),
    )
