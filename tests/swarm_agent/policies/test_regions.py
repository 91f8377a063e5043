"""Regions: nine squares of 20 m in the paper's arena, numbered from the south-west."""

from __future__ import annotations

from math import hypot

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from comms.arena import disc, rectangle
from swarm_agent.bcmommt.belief import Table, hear_mate, hear_position
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.step import Mind, new_mind
from swarm_agent.policies.regions import columns_of, decide, mates_in, most_urgent, region_of, rows_of, targets_in
from tests.swarm_agent.bcmommt.scene import NOW, PAPER_WORLD, params, sense, table

P = PAPER_WORLD
ME = 2
HERE, EAST, WEST = 4, 5, 3


def act(t: Table) -> tuple[Mind, float, float]:
    return decide(t, P, new_mind(0.0, 1.0), ME, 0.0, 0.0, NOW, 1, 100)


def known(t: Table, j: int, x: float, y: float) -> None:
    hear_position(t, j, x, y, 0.0, 0.0, NOW - 0.1)


def mate_at(t: Table, mate: int, x: float, y: float, age: float = 0.1) -> None:
    hear_mate(t, mate, x, y, NOW - age)


def see_around(t: Table, x: float, y: float) -> None:
    """The agent sees, from (x, y), the known targets that are within its range."""
    for j in range(len(t.sensed)):
        t.sensed[j] = hypot(t.x_m[j] - x, t.y_m[j] - y) <= P.sensing_range_m


def urgent(t: Table, me: int = ME, x: float = 0.0, y: float = 0.0) -> int:
    return most_urgent(t, P, me, region_of(P, x, y), x, y, NOW)


@pytest.mark.parametrize(
    ("x", "y", "region"), [(0, 0, 4), (-30, -30, 0), (29, -29, 2), (-15, 5, 3), (9.9, 10.1, 7), (45, 12, 8)]
)
def test_regions_are_counted_from_the_south_west(x: float, y: float, region: int) -> None:
    assert region_of(P, x, y) == region


def test_every_arena_has_regions_of_about_four_sensing_ranges() -> None:
    assert (columns_of(P), rows_of(P)) == (3, 3)
    field = params(arena=rectangle(200.0, 10.0))
    assert (columns_of(field), rows_of(field)) == (9, 1)
    assert columns_of(params(arena=disc(3.0))) == 1


def test_known_targets_and_mates_are_counted_where_they_are_by_now() -> None:
    t = table()
    sense(t, 0, 5.0, 0.0)
    hear_position(t, 1, 9.0, 0.0, 0.3, 0.0, NOW - 10.0)  # at 12 m east now
    known(t, 2, 16.0, 2.0)
    hear_position(t, 3, 15.0, 0.0, 0.0, 0.0, NOW - 25.0)  # too long ago
    assert targets_in(t, P, HERE, 0.0, 0.0, NOW) == pytest.approx((1, 5.0, 0.0))
    assert targets_in(t, P, EAST, 0.0, 0.0, NOW) == pytest.approx((2, 14.0, 1.0))
    assert targets_in(t, P, WEST, 0.0, 0.0, NOW) == (0, 0.0, 0.0)
    mate_at(t, 0, 12.0, 0.0)
    mate_at(t, 1, 12.0, 0.0, age=3.0)
    assert (mates_in(t, P, EAST, NOW), mates_in(t, P, HERE, NOW)) == (1, 0)


def test_in_its_region_it_follows_the_center_of_gravity_of_what_it_sees() -> None:
    t = table()
    sense(t, 0, 0.4, 0.0)
    sense(t, 1, 0.0, 0.2)
    mind, vx, vy = act(t)
    assert mind.mode is Mode.FOLLOW
    assert (vx, vy) == pytest.approx((0.2, 0.1))


def test_seeing_none_it_looks_for_those_known_in_its_region() -> None:
    t = table()
    known(t, 0, -9.0, 0.0)
    mind, vx, vy = act(t)
    assert mind.mode is Mode.EXPLORE
    assert (vx, vy) == pytest.approx((-0.4, 0.0))


def test_knowing_none_it_explores() -> None:
    mind, vx, vy = act(table())
    assert mind.mode is Mode.EXPLORE
    assert vy > 0.35
    assert hypot(vx, vy) == pytest.approx(0.4)


def test_an_idle_agent_moves_to_where_targets_outnumber_agents() -> None:
    t = table()
    known(t, 0, 15.0, 0.0)
    mate_at(t, 0, 16.0, 0.0)
    assert urgent(t) == HERE  # one to one
    known(t, 1, 25.0, 0.0)
    assert urgent(t) == EAST
    _, vx, vy = act(t)
    assert (vx, vy) == pytest.approx((0.4, 0.0))


def test_it_leaves_its_own_targets_only_for_a_more_urgent_region() -> None:
    t = table(n_targets=6)
    sense(t, 0, 1.0, 0.0)  # urgency 1
    for j in (1, 2, 3):
        known(t, j, 15.0, 0.0)
    mate_at(t, 0, 15.0, 0.0)
    assert urgent(t) == HERE  # 3 / 2 x 22 / (22 + 15) = 0.89
    known(t, 4, 15.0, 0.0)
    assert urgent(t) == EAST  # 4 / 2 x 22 / 37 = 1.19
    mind, vx, _ = act(t)
    assert mind.mode is Mode.FOLLOW  # it goes on telling what it sees
    assert vx == pytest.approx(0.4)


def test_of_two_agents_in_a_region_the_nearer_one_goes() -> None:
    t = table()
    known(t, 0, 15.0, 0.0)
    mate_at(t, 0, 3.0, 0.0)
    assert urgent(t) == HERE
    mate_at(t, 0, -3.0, 0.0)
    assert urgent(t) == EAST
    mate_at(t, 0, 0.0, 0.0)
    assert urgent(t) == HERE  # the same distance: the lower id goes
    mate_at(t, 0, 0.0, 0.0, age=5.0)
    mate_at(t, 3, 0.0, 0.0)
    assert urgent(t) == EAST


spots = st.tuples(st.integers(-29, 29), st.integers(-29, 29)).filter(lambda place: hypot(*place) < 30)


@given(st.lists(spots, min_size=6, max_size=6), st.lists(spots, max_size=2), spots)
def test_on_arrival_nobody_wants_back(
    targets: list[tuple[int, int]], mates: list[tuple[int, int]], start: tuple[int, int]
) -> None:
    t = table(n_targets=6)
    for j, (x, y) in enumerate(targets):
        known(t, j, x, y)
    for mate, (x, y) in enumerate(mates):
        mate_at(t, mate, x, y)
    home = region_of(P, *start)
    see_around(t, *start)
    goal = most_urgent(t, P, ME, home, *start, NOW)
    assume(goal != home)
    _, x, y = targets_in(t, P, goal, *start, NOW)
    see_around(t, x, y)
    assert most_urgent(t, P, ME, goal, x, y, NOW) != home
