"""Means and intervals, against tables and by hand."""

from __future__ import annotations

from math import inf, isnan, nan, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from missions.study.statistics import estimate, estimates, student, within


@pytest.mark.parametrize(
    ("degrees", "t"),
    # Student's t, two-sided 95 %, as in any table.
    [(1, 12.706), (2, 4.303), (3, 3.182), (4, 2.776), (5, 2.571), (9, 2.262), (10, 2.228), (30, 2.042), (60, 2.000),
     (99, 1.984), (120, 1.980), (1000, 1.962)],
)  # fmt: skip
def test_student_is_that_of_the_tables(degrees: int, t: float) -> None:
    assert student(degrees) == pytest.approx(t, abs=6e-4)


@given(st.integers(1, 499), st.floats(0, 50))
def test_probability_rises_with_t(degrees: int, t: float) -> None:
    assert 0.0 <= within(t, degrees) <= within(t + 0.1, degrees) + 1e-12 <= 1.0 + 2e-12


@given(st.integers(1, 3000))
def test_more_runs_need_a_smaller_t(degrees: int) -> None:
    # Where the series gives way to the expansion, too.
    assert student(degrees) > student(degrees + 1) > 1.9599


def test_an_interval_by_hand() -> None:
    # Mean 3, deviations -2 to 2: s = sqrt(10 / 4), t(0.975, 4) = 2.7764.
    told = estimate(np.array([1.0, 2.0, 3.0, 4.0, 5.0]))
    half = 2.776445 * sqrt(2.5) / sqrt(5)
    assert (told.mean, told.runs) == (3.0, 5)
    assert (told.low, told.high) == pytest.approx((3 - half, 3 + half), abs=1e-5)
    assert told.half == pytest.approx(half, abs=1e-5)


def test_runs_without_a_number_do_not_count() -> None:
    assert estimate(np.array([1.0, nan, 3.0])) == estimate(np.array([1.0, 3.0]))


def test_too_few_runs_say_so() -> None:
    assert estimate(np.array([2.0])).low == -inf
    assert estimate(np.array([2.0])).high == inf
    none = estimate(np.array([nan]))
    assert isnan(none.mean)
    assert none.runs == 0


def test_equal_runs_leave_no_doubt() -> None:
    told = estimate(np.full(10, 0.25))
    assert (told.low, told.mean, told.high) == (0.25, 0.25, 0.25)


def test_columns_are_told_one_by_one() -> None:
    mean, low, high = estimates(np.array([[1.0, 10.0], [3.0, 10.0]]))
    assert mean.tolist() == [2.0, 10.0]
    assert (low[1], high[1]) == (10.0, 10.0)
    assert (low[0], high[0]) == pytest.approx((2 - 12.7062, 2 + 12.7062), abs=1e-3)


def test_the_interval_holds_the_truth_in_nineteen_of_twenty_studies() -> None:
    draws = np.random.default_rng(5).normal(0.6, 0.2, size=(4000, 8))
    hits = sum(told.low <= 0.6 <= told.high for told in map(estimate, draws))
    assert 0.94 < hits / 4000 < 0.96
