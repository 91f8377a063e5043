"""What one agent knows: a table with a row per target, a row per mate and a row per cell of the arena.

Nothing enters but what this agent senses (`see`) and what reaches its radio (the `hear_*` rules). Everything decided
in a tick is computed from this table, the parameters, and passed-in chance.
"""

from __future__ import annotations

from bisect import insort
from math import ceil, floor, sqrt
from typing import Any, NamedTuple

from comms.arena import clamped
from comms.messages import on_wire
from swarm_agent.bcmommt.params import Params

NOBODY = -1
NEVER = -1.0e9  # an instant so long ago that every lease on it has run out
FAR = 1.0e9  # a distance or a span beyond all others

# Between two positions further apart in time than this (or two ticks), their quotient is not the target's velocity.
MAX_DIFFERENCE_S = 0.5
# Nor is it if the target would have been faster than this: then it was misplaced, or mistaken for another.
JUMP_M_S = 100.0

# What is older than all that holds by the mission's own spans is still shown to people for a while.
SHOWN_S = 30.0

Column = Any  # a list of numbers in flight, a numpy array in a study
Rows = Any  # a list of numbers in flight, a range in a study


class Table(NamedTuple):
    """One agent's knowledge, by column. Instants are mission-clock seconds; positions ENU meters.

    Per target: the best known position and velocity with their instant; own distance now and one tick ago (FAR when
    not sensed); own tag and call with the predicted time of loss; the best tag, the call and the answer heard of it,
    each with its speaker (NOBODY if none) and instant; and since when it is lost to this agent, its last owner.
    Per mate: position and instant of the last frame. Per cell: when it was last seen by anybody known of.

    The rules look at no rows but those of `known`, targets whose place is known, and of `mates`, who were heard, both
    in order: what an agent costs grows with its neighbors, not with the mission. A study looks at all rows.
    """

    known: Rows
    mates: Rows

    sensed: Column
    x_m: Column
    y_m: Column
    vx_m_s: Column
    vy_m_s: Column
    known_at_s: Column
    distance_m: Column
    distance_before_m: Column
    tagged: Column
    calling: Column
    loss_in_s: Column
    lost_at_s: Column
    owner: Column
    owner_distance_m: Column
    owner_at_s: Column
    caller: Column
    call_loss_at_s: Column
    caller_at_s: Column
    answerer: Column
    answer_capture_s: Column
    answerer_at_s: Column
    mate_x_m: Column
    mate_y_m: Column
    mate_at_s: Column
    cell_seen_at_s: Column


def new_table(n_targets: int, n_agents: int, n_cells: int) -> Table:
    """An agent that knows nothing yet, with list columns."""
    n = n_targets
    return Table(
        known=[],
        mates=[],
        sensed=[False] * n,
        x_m=[0.0] * n,
        y_m=[0.0] * n,
        vx_m_s=[0.0] * n,
        vy_m_s=[0.0] * n,
        known_at_s=[NEVER] * n,
        distance_m=[FAR] * n,
        distance_before_m=[FAR] * n,
        tagged=[False] * n,
        calling=[False] * n,
        loss_in_s=[FAR] * n,
        lost_at_s=[NEVER] * n,
        owner=[NOBODY] * n,
        owner_distance_m=[FAR] * n,
        owner_at_s=[NEVER] * n,
        caller=[NOBODY] * n,
        call_loss_at_s=[NEVER] * n,
        caller_at_s=[NEVER] * n,
        answerer=[NOBODY] * n,
        answer_capture_s=[FAR] * n,
        answerer_at_s=[NEVER] * n,
        mate_x_m=[0.0] * n_agents,
        mate_y_m=[0.0] * n_agents,
        mate_at_s=[NEVER] * n_agents,
        cell_seen_at_s=[NEVER] * n_cells,
    )


def enter(rows: Rows, row: int) -> None:
    """Add a row to those that are looked at. A study looks at all of them: there this compiles to nothing."""
    insort(rows, row)


def forget(t: Table, p: Params, now: float) -> None:
    """Take out the rows in which nothing holds any more: the rules need not look at them. To be called in a begun tick.

    Whatever is said of a target rests on a place not older than `memory_s`, and holds for less than all these spans
    together. So this changes no decision, and a study does without.
    """
    before = now - (p.memory_s + p.horizon_s + p.tag_lease_s + p.help_lease_s + SHOWN_S)
    for j in [j for j in t.known if t.known_at_s[j] < before]:
        if t.distance_before_m[j] == FAR and not t.calling[j]:  # else the clock has jumped, and it was mine a tick ago
            t.known.remove(j)
            t.known_at_s[j] = NEVER
    for mate in [mate for mate in t.mates if t.mate_at_s[mate] < before]:
        t.mates.remove(mate)
        t.mate_at_s[mate] = NEVER


def begin_tick(t: Table) -> None:
    """Forget what was sensed one tick ago, but for the distances: they are what mates will compare theirs with."""
    for j in t.known:
        t.distance_before_m[j] = t.distance_m[j]
        t.distance_m[j] = FAR
        t.sensed[j] = False


def see(t: Table, p: Params, j: int, x: float, y: float, me_x: float, me_y: float, now: float) -> None:
    """Target j is sensed at (x, y). Its velocity is the quotient of this and the last known position, if recent.

    Of several sightings of j in one tick (mistaken names) the last one's place counts, and the first one's velocity.
    """
    age = now - t.known_at_s[j]
    if t.known_at_s[j] == NEVER:
        enter(t.known, j)
    if age > 0.0:
        vx, vy = (x - t.x_m[j]) / age, (y - t.y_m[j]) / age
        if age > max(MAX_DIFFERENCE_S, 2.0 * p.tick_s) or vx * vx + vy * vy > JUMP_M_S * JUMP_M_S:
            vx, vy = 0.0, 0.0
        t.vx_m_s[j] = vx
        t.vy_m_s[j] = vy
    t.x_m[j] = x
    t.y_m[j] = y
    t.known_at_s[j] = now
    t.sensed[j] = True
    dx, dy = x - me_x, y - me_y
    # As mates will read it: both sides of a comparison must hold the same number.
    t.distance_m[j] = on_wire(sqrt(dx * dx + dy * dy))


def hear_mate(t: Table, mate: int, x: float, y: float, at: float) -> None:
    """A frame of `mate`, sent from (x, y) at `at`. It is whole: what it does not repeat is withdrawn (see `alive`)."""
    if t.mate_at_s[mate] == NEVER:
        enter(t.mates, mate)
    t.mate_x_m[mate] = x
    t.mate_y_m[mate] = y
    t.mate_at_s[mate] = at


def hear_position(t: Table, j: int, x: float, y: float, vx: float, vy: float, at: float) -> None:
    """Somebody saw target j at (x, y) at the instant `at`."""
    if at > t.known_at_s[j]:
        if t.known_at_s[j] == NEVER:
            enter(t.known, j)
        t.x_m[j] = x
        t.y_m[j] = y
        t.vx_m_s[j] = vx
        t.vy_m_s[j] = vy
        t.known_at_s[j] = at


def hear_tag(t: Table, p: Params, j: int, mate: int, distance: float, at: float) -> None:
    """`mate` claims target j from `distance` away. Of several claims the nearest counts."""
    if not (
        alive(t, t.owner[j], t.owner_at_s[j], p.tag_lease_s, at)
        and outranks(t.owner_distance_m[j], t.owner[j], distance, mate)
    ):
        t.owner[j] = mate
        t.owner_distance_m[j] = distance
        t.owner_at_s[j] = at


def hear_call(t: Table, p: Params, j: int, mate: int, loss_at: float, at: float) -> None:
    """`mate` calls for help: it will lose target j at `loss_at`. Of several calls the most urgent counts."""
    if not (
        alive(t, t.caller[j], t.caller_at_s[j], p.help_lease_s, at)
        and outranks(t.call_loss_at_s[j], t.caller[j], loss_at, mate)
    ):
        t.caller[j] = mate
        t.call_loss_at_s[j] = loss_at
        t.caller_at_s[j] = at


def hear_answer(t: Table, p: Params, j: int, mate: int, capture: float, at: float) -> None:
    """`mate` answers the call for target j and will have it in `capture` seconds. The quickest answer counts."""
    if not (
        alive(t, t.answerer[j], t.answerer_at_s[j], p.help_lease_s, at)
        and outranks(t.answer_capture_s[j], t.answerer[j], capture, mate)
    ):
        t.answerer[j] = mate
        t.answer_capture_s[j] = capture
        t.answerer_at_s[j] = at


def alive(t: Table, speaker: int, at: float, lease: float, now: float) -> bool:
    """Whether something said at `at` still holds: the speaker's last frame repeated it, and not too long ago.

    Claims, calls and answers are leases: they expire unless renewed.
    """
    return speaker != NOBODY and at >= t.mate_at_s[speaker] and now - at <= lease + 1e-6


def outranks(value: float, speaker: int, other_value: float, other_speaker: int) -> bool:
    """The smaller value wins (distance, time to capture, time of loss); equal values go to the lower agent id."""
    return value < other_value or (value == other_value and speaker < other_speaker)


def owned_by_mate(t: Table, p: Params, j: int, now: float) -> bool:
    """Whether a mate's claim on target j is in force."""
    return alive(t, t.owner[j], t.owner_at_s[j], p.tag_lease_s, now)


def called_by_mate(t: Table, p: Params, j: int, now: float) -> bool:
    """Whether a mate's help call for target j is in force."""
    return alive(t, t.caller[j], t.caller_at_s[j], p.help_lease_s, now)


def answered_by_mate(t: Table, p: Params, j: int, now: float) -> bool:
    """Whether a mate's answer to the call for target j is in force."""
    return alive(t, t.answerer[j], t.answerer_at_s[j], p.help_lease_s, now)


def predicted_place(t: Table, p: Params, j: int, now: float) -> tuple[float, float]:
    """Where target j is now: its last known position continued linearly (predictive tracking, section 4.1).

    Not beyond the edge: targets never leave the arena.
    """
    age = now - t.known_at_s[j]
    return clamped(p.arena, t.x_m[j] + t.vx_m_s[j] * age, t.y_m[j] + t.vy_m_s[j] * age)


def cell_columns(p: Params) -> int:
    """How many cells of side r_s lie side by side, east-west, over the arena."""
    return max(1, ceil(2.0 * p.arena.half_x_m / p.sensing_range_m))


def cell_rows(p: Params) -> int:
    """How many cells of side r_s lie side by side, north-south, over the arena."""
    return max(1, ceil(2.0 * p.arena.half_y_m / p.sensing_range_m))


def cell_x(p: Params, cell: int) -> float:
    """The center of a cell, east."""
    columns = cell_columns(p)
    return ((cell % columns) + 0.5) * 2.0 * p.arena.half_x_m / columns - p.arena.half_x_m


def cell_y(p: Params, cell: int) -> float:
    """The center of a cell, north."""
    columns, rows = cell_columns(p), cell_rows(p)
    return ((cell // columns) + 0.5) * 2.0 * p.arena.half_y_m / rows - p.arena.half_y_m


def see_cells(t: Table, p: Params, x: float, y: float, at: float) -> None:
    """An agent at (x, y) sees the cells whose centers are within r_s: own sight, or a mate's as its frame tells."""
    columns, rows = cell_columns(p), cell_rows(p)
    width, height = 2.0 * p.arena.half_x_m / columns, 2.0 * p.arena.half_y_m / rows
    reach = p.sensing_range_m
    first_column = max(0, floor((x - reach + p.arena.half_x_m) / width))
    last_column = min(columns - 1, floor((x + reach + p.arena.half_x_m) / width))
    first_row = max(0, floor((y - reach + p.arena.half_y_m) / height))
    last_row = min(rows - 1, floor((y + reach + p.arena.half_y_m) / height))
    for row in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            cell = row * columns + column
            dx, dy = cell_x(p, cell) - x, cell_y(p, cell) - y
            if dx * dx + dy * dy <= reach * reach and at > t.cell_seen_at_s[cell]:
                t.cell_seen_at_s[cell] = at
