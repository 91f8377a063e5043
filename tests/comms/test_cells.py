"""Cells find whom a look at all pairs finds, in the same order."""

from __future__ import annotations

from math import inf, nan

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from comms.cells import Cells
from comms.link import in_range

LENGTHS = st.floats(-1e5, 1e5, allow_nan=False)
POINTS = st.lists(st.none() | st.tuples(LENGTHS, LENGTHS), max_size=30)
# Differences near the range itself, where rounding decides.
RANGES = st.floats(0.1, 1e4)
STEPS = st.integers(-3, 3)


def all_pairs(points: list[tuple[float, float] | None], x: float, y: float, range_m: float) -> list[int]:
    return [i for i, p in enumerate(points) if p is not None and in_range(p[0] - x, p[1] - y, range_m)]


def by_cells(points: list[tuple[float, float] | None], x: float, y: float, range_m: float) -> list[int]:
    near = Cells(points, range_m=range_m).near(x, y)
    assert near == sorted(near)
    return [i for i in near if in_range(points[i][0] - x, points[i][1] - y, range_m)]  # type: ignore[index]


@given(points=POINTS, x=LENGTHS, y=LENGTHS, range_m=RANGES)
def test_cells_find_whom_all_pairs_find(
    points: list[tuple[float, float] | None], x: float, y: float, range_m: float
) -> None:
    assert by_cells(points, x, y, range_m) == all_pairs(points, x, y, range_m)


@given(x=LENGTHS, y=LENGTHS, range_m=RANGES, steps=st.lists(st.tuples(STEPS, STEPS), max_size=20))
@example(x=-1e-20, y=0.0, range_m=5.0, steps=[(1, 0)])
@example(x=5.0, y=-5.0, range_m=5.0, steps=[(-1, 0), (0, 1), (1, 1)])
def test_a_point_at_the_very_range_is_found(x: float, y: float, range_m: float, steps: list[tuple[int, int]]) -> None:
    points: list[tuple[float, float] | None] = [(x + a * range_m, y + b * range_m) for a, b in steps]
    assert by_cells(points, x, y, range_m) == all_pairs(points, x, y, range_m)


@pytest.mark.parametrize("lost", [nan, inf, -inf, 1e300])
def test_what_is_nowhere_is_near_nobody(lost: float) -> None:
    points = [(0.0, 0.0), (lost, 0.0), None]
    assert by_cells(points, 0.0, 0.0, 5.0) == [0]
    assert by_cells(points, lost, lost, 5.0) == []
