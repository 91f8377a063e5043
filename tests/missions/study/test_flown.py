"""From ticks to seconds, windows of time, and the numbers of a run, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from missions.study.flown import COUNTS, Flown, second_starts
from missions.study.metrics import QUANTITIES, Window


def flown(seen: list[list[int]], present: int, *, seeds: list[int] | None = None, agents: int = 2) -> Flown:
    rows = np.array(seen, dtype=np.int64)
    names = seeds or list(range(len(seen)))
    counts = np.array([[seed * 10 + kind for kind in range(len(COUNTS))] for seed in names], dtype=np.int64)
    late = rows[:, -1] / max(present, 1)
    return Flown(np.array(names), rows, np.full_like(rows, present), counts, late, agents, 4)


RUNS = flown([[40, 20, 0, 10], [40, 40, 20, 30]], 40)


def test_ticks_belong_to_the_second_they_fall_into() -> None:
    assert second_starts(25, 0.1).tolist() == [0, 10, 20]
    assert second_starts(5, 0.5).tolist() == [0, 2, 4]
    assert second_starts(4, 0.4).tolist() == [0, 3]  # 0, 0.4, 0.8 | 1.2
    assert second_starts(3, 1.0).tolist() == [0, 1, 2]
    # 0.1 is no binary fraction: the tenth tick is still the first of its second.
    assert second_starts(3600, 0.1).tolist() == list(range(0, 3600, 10))


def test_coverage_of_a_window() -> None:
    assert RUNS.share().tolist() == [70 / 160, 130 / 160]
    assert RUNS.share(from_s=1, until_s=3).tolist() == [20 / 80, 60 / 80]
    assert RUNS.share(from_s=3).tolist() == [0.25, 0.75]


def test_a_window_without_targets_has_no_coverage() -> None:
    assert np.isnan(flown([[0, 0]], 0).share()).all()


@pytest.mark.parametrize(
    ("metric", "window", "expected"),
    [
        ("coverage", Window(0, 1), [1.0, 1.0]),
        ("coverage_late", Window(), [0.25, 0.75]),
        ("utilization", Window(), [2 * 70 / 160, 2 * 130 / 160]),  # four targets, two agents
        ("lowest", Window(), [0.0, 0.5]),  # the means are 1, .75, .25, .5
        ("lowest", Window(0, 2), [0.5, 1.0]),
        ("escaped", Window(), [4.0, 2.0]),
        ("target_loss", Window(), [0.0, 10.0]),
        ("taken_over", Window(), [6.0, 16.0]),
    ],
)
def test_numbers_by_hand(metric: str, window: Window, expected: list[float]) -> None:
    assert QUANTITIES[metric].of(RUNS, window).tolist() == pytest.approx(expected)


def test_joining_and_choosing_go_by_seed() -> None:
    one, two = flown([[1], [3]], 4, seeds=[1, 3]), flown([[4], [2], [3]], 4, seeds=[4, 2, 3])
    whole = one.joined([two])
    assert (whole.seeds.tolist(), whole.seen[:, 0].tolist()) == ([1, 2, 3, 4], [1, 2, 3, 4])
    assert whole.counts[:, 0].tolist() == [10, 20, 30, 40]
    assert two.of_seeds(range(3, 9)).seen[:, 0].tolist() == [3, 4]


def test_numbers_are_told_with_their_units() -> None:
    assert QUANTITIES["coverage"].with_spread(0.9312, 0.0049) == "93.1 % ± 0.5"
    assert QUANTITIES["calls"].with_spread(3.25, 0.5) == "3.25 ± 0.5 per run"
    assert QUANTITIES["coverage"].spread(float("inf")) == "?"
