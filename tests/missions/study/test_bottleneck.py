"""The linear bottleneck assignment against every assignment there is."""

from __future__ import annotations

from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st

np = pytest.importorskip("numpy")
pytest.importorskip("numba")

from missions.study.compiled.bottleneck import match_bottleneck  # noqa: E402
from swarm_agent.bcmommt.belief import FAR, NOBODY  # noqa: E402

costs = st.one_of(st.sampled_from([1.0, 2.0, 3.0, FAR]), st.floats(0.5, 100.0))


def assigned(rows: list[list[float]]) -> list[int]:
    cost = np.array(rows)
    m, n = cost.shape
    column_of, row_of = np.zeros(m, np.int64), np.zeros(n, np.int64)
    match_bottleneck(cost, column_of, row_of, np.zeros(n, np.int64), np.zeros(m, np.int64))
    assert [row_of[c] for r, c in enumerate(column_of) if c != NOBODY] == [
        r for r, c in enumerate(column_of) if c != NOBODY
    ]
    return [int(column) for column in column_of]


def value(rows: list[list[float]], columns: list[int]) -> tuple[int, float]:
    """How many pairs an assignment has (fewer is worse), and what the worst of them costs."""
    paid = [rows[r][c] for r, c in enumerate(columns) if c != NOBODY and rows[r][c] < FAR]
    return -len(paid), max(paid, default=0.0)


def best_of_all(rows: list[list[float]]) -> tuple[int, float]:
    m, n = len(rows), len(rows[0])
    places = [*range(n), *[NOBODY] * m]
    return min(value(rows, list(columns)) for columns in set(permutations(places, m)))


@given(st.integers(1, 3).flatmap(lambda n: st.lists(st.lists(costs, min_size=n, max_size=n), min_size=1, max_size=3)))
def test_no_assignment_has_more_pairs_or_a_better_worst_one(rows: list[list[float]]) -> None:
    columns = assigned(rows)
    assert all(c == NOBODY or rows[r][c] < FAR for r, c in enumerate(columns))
    assert value(rows, columns) == best_of_all(rows)


def test_the_greedy_choice_of_the_nearest_is_not_the_bottleneck() -> None:
    # Greedy: agent 0 takes call 0 in 1 s, which leaves 9 s for agent 1. The bottleneck is 5 s.
    assert assigned([[1.0, 5.0], [4.0, 9.0]]) == [1, 0]


def test_who_cannot_help_is_not_sent() -> None:
    assert assigned([[FAR, FAR], [3.0, FAR]]) == [NOBODY, 0]
