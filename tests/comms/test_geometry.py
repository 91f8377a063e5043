"""Arena, frames and chance: the plain numbers everything else stands on."""

from __future__ import annotations

from itertools import pairwise
from math import cos, hypot, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comms import arena, chance
from comms.frames import GeoPoint, enu_from_geo, geo_from_enu, swap_enu_ned

coordinates = st.floats(-100, 100)
arenas = st.one_of(
    st.builds(arena.disc, st.floats(1, 90)), st.builds(arena.rectangle, st.floats(1, 90), st.floats(1, 90))
)
HOME = GeoPoint(-35.363262, 149.165237, 584.0)


@given(arenas, coordinates, coordinates)
def test_clamping_brings_inside_and_leaves_the_inside_alone(area: arena.Arena, x: float, y: float) -> None:
    a, b = arena.clamped(area, x, y)
    assert arena.edge_distance_m(area, a, b) >= -1e-9
    if arena.edge_distance_m(area, x, y) >= 0:
        assert (a, b) == (x, y)


@given(arenas, coordinates, coordinates, st.floats(0, 6.28))
def test_a_reflected_heading_points_inward_and_keeps_its_length(
    area: arena.Arena, x: float, y: float, angle: float
) -> None:

    ux, uy = arena.reflected(area, x, y, cos(angle), sin(angle))
    nx, ny = arena.outward_normal(area, x, y)
    assert ux * nx + uy * ny <= 1e-9
    assert hypot(ux, uy) == pytest.approx(1.0)


def test_hand_computed_arenas() -> None:
    field = arena.rectangle(40.0, 20.0)
    assert arena.area_m2(field) == 800.0
    assert arena.area_m2(arena.disc(10.0)) == pytest.approx(314.159265)
    assert arena.edge_distance_m(field, 15.0, 2.0) == 5.0
    assert arena.clamped(field, 25.0, -30.0) == (20.0, -10.0)
    assert arena.clamped(arena.disc(5.0), 6.0, 8.0) == (3.0, 4.0)
    assert arena.reflected(field, 20.0, 0.0, 0.6, 0.8) == pytest.approx((-0.6, 0.8))


@given(st.tuples(st.floats(-5000, 5000), st.floats(-5000, 5000), st.floats(-100, 500)))
def test_the_globe_and_back(enu: tuple[float, float, float]) -> None:
    assert enu_from_geo(HOME, geo_from_enu(HOME, enu)) == pytest.approx(enu, abs=1e-6)


def test_a_degree_north_is_what_ardupilot_takes_it_for() -> None:
    assert enu_from_geo(HOME, GeoPoint(-34.363262, 149.165237, 600.0)) == pytest.approx((0.0, 111319.490793, 16.0))


def test_east_north_up_and_north_east_down_swap_both_ways() -> None:
    assert swap_enu_ned((1.0, 2.0, 3.0)) == (2.0, 1.0, -3.0)
    assert swap_enu_ned(swap_enu_ned((1.0, 2.0, 3.0))) == (1.0, 2.0, 3.0)


def test_draws_are_uniform_and_independent_of_each_other() -> None:
    draws = [chance.draw(1, tick, who, chance.LINK_LOSS) for tick in range(200) for who in range(50)]
    assert sum(draws) / len(draws) == pytest.approx(0.5, abs=0.01)
    tenths = [sum(int(d * 10) == tenth for d in draws) for tenth in range(10)]
    assert min(tenths) > 850
    assert max(tenths) < 1150
    pairs = [(a - 0.5) * (b - 0.5) for a, b in pairwise(draws)]
    assert sum(pairs) / len(pairs) == pytest.approx(0.0, abs=0.005)


def test_every_key_changes_a_draw_and_equal_keys_repeat_it() -> None:
    first = chance.draw(1, 2, 3, 4)
    assert first == chance.draw(1, 2, 3, 4)
    assert len({first, chance.draw(2, 2, 3, 4), chance.draw(1, 3, 3, 4), chance.draw(1, 2, 4, 4)}) == 4
    assert first == 0.5753611233085394  # a recorded run must draw the same tomorrow
