"""How targets move, and what is seen of them."""

from __future__ import annotations

from math import cos, hypot, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comms.arena import disc, edge_distance_m, rectangle
from vehicle_sim.herd import Evasive, Herd, Random, Replay, Static
from vehicle_sim.placement import heading, scatter
from vehicle_sim.targets import evade, flight_direction
from vehicle_sim.tracks import parse_tracks

ARENA = disc(30.0)


def flee(x: float, y: float, *agents: tuple[float, float]) -> tuple[float, float, float, float]:
    xs, ys = [a[0] for a in agents], [a[1] for a in agents]
    return evade(ARENA, x, y, 1.0, 0.0, xs, ys, 5.5, 0.3, 0.1, 1, 0, 0)


def test_eq_8_an_agent_drives_its_target_straight_away() -> None:
    assert flee(2.0, 0.0, (2.0, 3.0)) == pytest.approx((2.0, -0.03, 0.0, -1.0))


def test_several_agents_drive_along_the_sum_of_unit_vectors() -> None:
    x, y, ux, uy = flee(0.0, 0.0, (-1.0, 0.0), (0.0, -4.0))
    assert (ux, uy) == pytest.approx((0.70711, 0.70711), abs=1e-5)
    assert hypot(x, y) == pytest.approx(0.03)


def test_who_is_beyond_its_senses_does_not_drive_it() -> None:
    assert flight_direction(0.0, 0.0, [5.51], [0.0], 5.5) == (0.0, 0.0, False)
    assert flight_direction(0.0, 0.0, [5.5], [0.0], 5.5) == (-1.0, 0.0, True)


@pytest.mark.parametrize("agents", [[(0.0, 0.0)], [(0.0, 0.0005)], [(0.0, 2.0), (0.0, -2.0)]])
def test_right_below_or_in_balance_it_keeps_its_heading(agents: list[tuple[float, float]]) -> None:
    assert flee(0.0, 0.0, *agents) == pytest.approx((0.03, 0.0, 1.0, 0.0))


spots = st.tuples(st.floats(-20, 20), st.floats(-20, 20))


@given(spots, st.lists(st.tuples(st.floats(-40, 40), st.floats(-40, 40)), max_size=4), st.floats(0, 6.28))
def test_no_target_leaves_the_arena_or_outruns_its_speed(
    start: tuple[float, float], agents: list[tuple[float, float]], angle: float
) -> None:
    xs, ys = [a[0] for a in agents], [a[1] for a in agents]
    x, y, ux, uy = *start, cos(angle), sin(angle)
    for tick in range(30):
        before = (x, y)
        x, y, ux, uy = evade(ARENA, x, y, ux, uy, xs, ys, 5.5, 3.0, 0.1, 1, tick, 0)
        assert edge_distance_m(ARENA, x, y) >= -1e-9
        assert hypot(x - before[0], y - before[1]) <= 0.3 + 1e-9
        assert hypot(ux, uy) == pytest.approx(1.0)


def herds() -> list[Herd]:
    places = scatter(count=8, radius_m=9.0, spacing_m=0.0, seed=3, purpose=1)
    headings = [heading(who=j, seed=3, purpose=1) for j in range(8)]
    arena = rectangle(20.0, 20.0)
    tracks = parse_tracks("t,id,x,y\n0,a,0,0\n20,a,200,0\n5,b,1,1\n9,b,1,5\n", source="tracks.csv")
    common = {"arena": arena, "places": places, "headings": headings, "tick_s": 0.1, "seed": 3}
    return [
        Static(**common),  # type: ignore[arg-type]
        Random(**common, speed_m_s=1.0),  # type: ignore[arg-type]
        Evasive(**common, speed_m_s=1.0, notice_range_m=3.0),  # type: ignore[arg-type]
        Replay(arena=arena, tracks=tracks, tick_s=0.1),
    ]


@pytest.mark.parametrize("index", range(4))
def test_every_herd_stays_inside_and_repeats_itself(index: int) -> None:
    first, second = herds()[index], herds()[index]
    for tick in range(250):
        assert first.places == second.places
        for place in first.places:
            assert place is None or max(abs(place[0]), abs(place[1])) <= 10.0 + 1e-9
        for herd in (first, second):
            herd.advance(tick, [0.0, 4.0], [0.0, 4.0])


def test_static_targets_stand_and_random_ones_turn_about_once_in_twenty_seconds() -> None:
    static, roaming = herds()[0], herds()[1]
    before = list(static.places)
    static.advance(0, [], [])
    assert static.places == before
    field = disc(10_000.0)
    roaming = Random(
        arena=field, places=[(0.0, 0.0)] * 20, headings=[(1.0, 0.0)] * 20, tick_s=0.1, seed=1, speed_m_s=1.0
    )
    turns, steps = 0, [(0.1, 0.0)] * 20
    for tick in range(1000):
        old = list(roaming.places)
        roaming.advance(tick, [], [])
        for j in range(20):
            (ax, ay), (bx, by) = old[j] or (0, 0), roaming.places[j] or (0, 0)
            turns += hypot(bx - ax - steps[j][0], by - ay - steps[j][1]) > 1e-6
            steps[j] = (bx - ax, by - ay)
    assert turns / 20 == pytest.approx(0.05 * 100.0, rel=0.25)  # 100 s at 5 % a second


def test_a_replay_interpolates_brings_back_to_the_edge_and_lets_animals_come_and_go() -> None:
    herd = herds()[3]
    assert herd.places == [(0.0, 0.0), None]
    for tick in range(70):
        herd.advance(tick, [], [])
    assert herd.places == [(10.0, 0.0), (pytest.approx(1.0), pytest.approx(3.0))]  # 70 m east is outside
    for tick in range(70, 201):
        herd.advance(tick, [], [])
    assert herd.places == [None, None]


def test_scatter_fills_the_disc_keeps_its_distance_and_says_when_it_is_full() -> None:
    places = scatter(count=40, radius_m=15.0, spacing_m=2.0, seed=1, purpose=5)
    assert all(hypot(x, y) <= 15.0 for x, y in places)
    gaps = [hypot(a[0] - b[0], a[1] - b[1]) for k, a in enumerate(places) for b in places[:k]]
    assert min(gaps) >= 2.0
    many = scatter(count=2000, radius_m=10.0, spacing_m=0.0, seed=1, purpose=5)
    assert sum(hypot(x, y) < 5.0 for x, y in many) / 2000 == pytest.approx(0.25, abs=0.03)  # uniform by area
    with pytest.raises(ValueError, match="no room for 50 places 5 m apart within 5 m"):
        scatter(count=50, radius_m=5.0, spacing_m=5.0, seed=1, purpose=5)
