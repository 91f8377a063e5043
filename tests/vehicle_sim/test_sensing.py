"""Laws of sensing: who sees what, and under which names."""

from __future__ import annotations

from collections import Counter
from math import cos, radians, sin, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comms.arena import disc
from comms.chance import IDENTITY_ERROR, draw
from vehicle_sim.herd import Place, Static
from vehicle_sim.sensing import ALL_AROUND, facing, reported, sees
from vehicle_sim.world import World

THREE: tuple[Place, ...] = ((0.0, 0.0), (8.0, 0.0), (20.0, 0.0))

EAST, STILL = (1.0, 0.0), (0.0, 0.0)


def world(
    *,
    identity_error: float = 0.0,
    places: tuple[Place, ...] = THREE,
    ranges_m: tuple[float, ...] = (5.0,),
    cos_half_opening: float = ALL_AROUND,
) -> World:
    herd = Static(arena=disc(30.0), places=places, headings=[(1.0, 0.0)] * len(places), tick_s=0.1, seed=1)
    return World(
        herd=herd,
        sensing_ranges_m=ranges_m,
        headings=[EAST] * len(ranges_m),
        cos_half_opening=cos_half_opening,
        identity_error=identity_error,
        seed=1,
    )


def test_sensing_is_a_disc_and_tells_each_agent_its_own() -> None:
    place = world(ranges_m=(5.0, 5.0, 5.0))
    seen = place.sense(0, [(5.0, 0.0), (0.0, 5.001), (8.0, 0.0)], [STILL] * 3)
    assert [[s.target for s in agent] for agent in seen] == [[0, 1], [], [1]]
    assert seen[0][0] == (0, 0.0, 0.0)
    assert place.seen == [True, True, False]


def test_each_agent_has_its_own_range() -> None:
    seen = world(ranges_m=(7.9, 8.0, 20.0)).sense(0, [(0.0, 0.0)] * 3, [STILL] * 3)
    assert [[s.target for s in agent] for agent in seen] == [[0], [0, 1], [0, 1, 2]]


# Where agents look.


@pytest.mark.parametrize(
    ("opening_deg", "bearing_deg", "seen"),
    [
        (90, 0, True), (90, 44.9, True), (90, -44.9, True), (90, 45.1, False), (90, 180, False),
        (180, 89.9, True), (180, 90.1, False),
        (270, 134.9, True), (270, -134.9, True), (270, 135.1, False), (270, 180, False),
    ],
)  # fmt: skip
def test_a_sector_is_half_to_the_left_and_half_to_the_right(opening_deg: float, bearing_deg: float, seen: bool) -> None:
    cosine = cos(radians(opening_deg / 2))
    for turn_deg in (0, 77, 200):
        ux, uy = cos(radians(turn_deg)), sin(radians(turn_deg))
        angle = radians(turn_deg + bearing_deg)
        assert sees(3.0 * cos(angle), 3.0 * sin(angle), 5.0, ux, uy, cosine) == seen
        assert not sees(6.0 * cos(angle), 6.0 * sin(angle), 5.0, ux, uy, cosine)
        assert sees(3.0 * cos(angle), 3.0 * sin(angle), 5.0, ux, uy, ALL_AROUND)


def test_what_is_right_below_is_in_every_sector() -> None:
    assert sees(0.0, 0.0, 5.0, 1.0, 0.0, cos(radians(0.5)))


def test_an_agent_looks_where_it_flies_and_keeps_looking_there_while_it_stands() -> None:
    assert facing(1.0, 0.0, 0.0, -0.4) == (0.0, -1.0)
    assert facing(1.0, 0.0, 0.3, 0.4) == (pytest.approx(0.6), pytest.approx(0.8))
    assert facing(0.6, 0.8, 0.03, -0.03) == (0.6, 0.8)  # slower than 0.05 m/s
    place = world(cos_half_opening=cos(radians(45)))
    here: list[Place | None] = [(4.0, 0.0)]  # between a target 4 m to the west and one 4 m to the east
    looks = [[s.target for s in place.sense(0, here, [v])[0]] for v in (STILL, (-0.4, 0.0), STILL, (0.0, 0.4))]
    assert looks == [[1], [0], [0], []]


# Mistaken names.


@given(
    n_targets=st.integers(1, 40),
    seed=st.integers(0, 2**32 - 1),
    error=st.floats(0, 1),
    tick=st.integers(0, 10**6),
    data=st.data(),
)
def test_a_name_is_that_of_some_target_and_the_wrong_ones_only_grow(
    n_targets: int, seed: int, error: float, tick: int, data: st.DataObject
) -> None:
    target = data.draw(st.integers(0, n_targets - 1))
    name = reported(target, n_targets, error, 3, seed, tick)
    assert 0 <= name < n_targets
    assert (name != target) == (n_targets > 1 and draw(seed, tick, 3 * n_targets + target, IDENTITY_ERROR) < error)


def test_one_draw_says_whether_and_which() -> None:
    # Agent 0 sees target 0 of 4 with error .5: a chance of .3 is .6 of the way through three others, the second.
    tick = next(k for k in range(10**5) if 0.2999 < draw(1, k, 0, IDENTITY_ERROR) < 0.3001)
    assert reported(0, 4, 0.5, 0, 1, tick) == 2
    assert reported(0, 4, 0.25, 0, 1, tick) == 0  # it is right with a smaller error
    assert reported(0, 1, 1.0, 0, 1, tick) == 0  # nobody else to be taken for


@pytest.mark.parametrize("error", [0.1, 0.5, 1.0])
def test_errors_are_as_frequent_as_asked_and_all_others_are_as_likely(error: float) -> None:
    draws = 20_000
    names = Counter(reported(2, 5, error, uid, 1, tick) for uid in range(10) for tick in range(draws // 10))
    for name in range(5):
        share = 1.0 - error if name == 2 else error / 4
        sigma = sqrt(share * (1.0 - share) / draws)
        assert names[name] / draws == pytest.approx(share, abs=4 * sigma)


def test_agents_and_ticks_err_independently() -> None:
    draws = 20_000
    wrong = [[reported(0, 5, 0.5, uid, 1, tick) != 0 for tick in range(draws)] for uid in (0, 1)]
    both = sum(a and b for a, b in zip(*wrong, strict=True)) / draws
    twice = sum(a and b for a, b in zip(wrong[0], wrong[0][1:], strict=False)) / draws
    assert both == pytest.approx(0.25, abs=4 * sqrt(0.25 * 0.75 / draws))
    assert twice == pytest.approx(0.25, abs=4 * sqrt(0.25 * 0.75 / draws))


def test_the_world_mistakes_names_not_places_and_coverage_counts_the_target() -> None:
    place = world(identity_error=1.0)
    for tick in range(50):
        ((seen,),) = place.sense(tick, [(0.0, 0.0)], [STILL])
        assert seen.target in (1, 2)
        assert seen[1:] == (0.0, 0.0)
        assert place.seen == [True, False, False]


def test_two_sightings_may_bear_one_name() -> None:
    near: tuple[Place, ...] = ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0))
    named = {
        tuple(s.target for s in world(identity_error=1.0, places=near).sense(k, [(1.0, 0.0)], [STILL])[0])
        for k in range(99)
    }
    assert (1, 0, 0) in named
    assert all(name != target for names in named for target, name in enumerate(names))
