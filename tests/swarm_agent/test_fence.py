"""Fences: what is inside, and which walls are near."""

from __future__ import annotations

from math import cos, hypot, sin, tau

import pytest
from hypothesis import given
from hypothesis import strategies as st

from swarm_agent.fence import Fence, Wall, circle, encloses, polygon, walls

SQUARE = polygon([(10.0, 10.0), (-10.0, 10.0), (-10.0, -10.0), (10.0, -10.0)])
# An L: the north-east quarter of the square is outside.
ANGLE = polygon([(-10.0, -10.0), (10.0, -10.0), (10.0, 0.0), (0.0, 0.0), (0.0, 10.0), (-10.0, 10.0)])
ANYWHERE = st.floats(-30.0, 30.0)


@pytest.mark.parametrize(
    ("place", "square", "angle"),
    [
        ((0.5, 0.5), True, False),
        ((-0.5, 0.5), True, True),
        ((9.9, 9.9), True, False),
        ((9.9, -0.1), True, True),
        ((10.1, 0.0), False, False),
        ((0.0, -10.1), False, False),
        ((1e300, 0.0), False, False),
    ],
)
def test_inside(place: tuple[float, float], square: bool, angle: bool) -> None:
    assert encloses(SQUARE.corners_m, *place) is square
    assert encloses(ANGLE.corners_m, *place) is angle


def test_core_is_the_circle_about_home_that_is_inside() -> None:
    assert SQUARE.core_m == 10.0
    assert ANGLE.core_m == 0.0  # home is a corner
    assert polygon([(5.0, 5.0), (6.0, 5.0), (5.0, 6.0)]).core_m == 0.0
    assert circle(50.0).core_m == pytest.approx(50.0, rel=0.0013)


@given(st.floats(0.0, tau), st.floats(0.0, 49.9))
def test_a_circle_encloses_what_is_nearer_than_its_radius(angle: float, radius_m: float) -> None:
    assert encloses(circle(50.0).corners_m, radius_m * cos(angle), radius_m * sin(angle))


def test_walls_are_the_sides_in_reach() -> None:
    assert walls(SQUARE, 0.0, 0.0, reach_m=9.0) == []
    assert walls(SQUARE, 8.0, 0.0, reach_m=5.0) == [Wall(1.0, 0.0, 2.0)]
    assert set(walls(SQUARE, 8.0, 7.0, reach_m=5.0)) == {Wall(1.0, 0.0, 2.0), Wall(0.0, 1.0, 3.0)}


def test_from_outside_the_wall_is_behind() -> None:
    assert walls(SQUARE, 14.0, 0.0, reach_m=1.0) == [Wall(1.0, 0.0, -4.0)]
    assert walls(ANGLE, 3.0, 5.0, reach_m=1.0) == [Wall(1.0, 0.0, -3.0)]


@pytest.mark.parametrize("fence", [SQUARE, ANGLE, circle(12.0)])
@given(x=ANYWHERE, y=ANYWHERE, heading=st.floats(0.0, tau))
def test_who_stays_on_this_side_of_every_wall_stays_inside(fence: Fence, x: float, y: float, heading: float) -> None:
    east, north = cos(heading), sin(heading)
    found = walls(fence, x, y, reach_m=100.0)
    if min((wall.distance_m for wall in found), default=0.0) < 1e-6:  # outside, or on the line
        return
    step_m = min(
        (w.distance_m / (east * w.east + north * w.north) for w in found if east * w.east + north * w.north > 1e-9),
        default=0.0,
    )
    assert all(hypot(wall.east, wall.north) == pytest.approx(1.0) for wall in found)
    assert encloses(fence.corners_m, x + 0.999 * step_m * east, y + 0.999 * step_m * north)
