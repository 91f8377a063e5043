"""Situations on hand-made runs: agent 0 at rest has two targets that drift away; every kind of interference ends it."""

from __future__ import annotations

from typing import Any

import pytest

np = pytest.importorskip("numpy")
pytest.importorskip("numba")

from missions.study.engine import Trace  # noqa: E402
from missions.training.rows import rows_of  # noqa: E402
from missions.training.situations import Situation, find_situations  # noqa: E402

RANGE_M, TICK_S, TICKS = 5.0, 0.5, 8
FAR_AWAY = (100.0, 100.0)


def run(third: tuple[float, float] = FAR_AWAY, mate: dict[int, tuple[float, float]] | None = None) -> Trace:
    """Targets 0 and 1 leave agent 0 by 1 m a tick, east and west, from 1 m: beyond 5 m from tick 5 on."""
    agents = np.zeros((TICKS, 2, 2))
    agents[:, 1] = (-100.0, -100.0)
    for tick, place in (mate or {}).items():
        agents[tick, 1] = place
    targets = np.zeros((TICKS, 3, 2))
    targets[:, 0, 0] = 1.0 + np.arange(TICKS)
    targets[:, 1, 0] = -1.0 - np.arange(TICKS)
    targets[:, 2] = third
    gaps = agents[:, :, None] - targets[:, None]
    sensed: Any = (gaps**2).sum(-1) <= RANGE_M**2
    tagged = sensed.copy()
    tagged[:, 1] = False  # agent 0 is the owner of what it senses
    none = np.zeros(TICKS, np.int32)
    return Trace(agents, targets, tagged, sensed, np.zeros((TICKS, 2), np.int8), none, none, none, none)


def found(trace: Trace, n_tags: int = 2) -> list[Situation]:
    return find_situations(trace, n_tags, notice_range_m=RANGE_M)


def test_from_the_first_tick_to_the_loss() -> None:
    assert found(run()) == [Situation(agent=0, targets=(0, 1), first=0, loss=5)]
    assert found(run(), 3) == []


def test_three_targets_are_a_situation_of_three() -> None:
    with_third = run(third=(0.0, 2.0))
    assert found(with_third) == []
    assert found(with_third, 3) == [Situation(agent=0, targets=(0, 1, 2), first=0, loss=5)]


def test_it_begins_when_the_interference_ends() -> None:
    assert found(run(mate={0: (3.0, 0.0), 1: (3.0, 0.0)})) == [Situation(0, (0, 1), first=2, loss=5)]


def test_a_mate_that_comes_near_before_the_loss_spoils_it() -> None:
    assert found(run(mate={4: (9.0, 3.0)})) == []  # 5 m from target 0 at (5, 0)
    assert len(found(run(mate={4: (9.1, 3.0)}))) == 1


def test_a_target_seen_and_owned_by_another_spoils_it() -> None:
    trace = run(third=(0.0, 2.0))
    trace.tagged[:, 0, 2] = False
    assert found(trace) == []


def test_a_dropped_tag_is_no_loss() -> None:
    trace = run()
    trace.tagged[3:, 0, 0] = False
    assert found(trace) == []


def test_a_run_that_ends_is_no_loss() -> None:
    trace = run()
    short = Trace(*(column[:5] for column in vars(trace).values()))
    assert found(short) == []


def test_rows_by_hand() -> None:
    trace = run()
    rows = rows_of(trace, found(trace), tick_s=TICK_S, range_m=RANGE_M)
    # Ticks 1 to 4: eq. 10 needs one tick before. At 2, 3, 4, 5 m on both sides.
    assert rows.situations == 1
    assert rows.inputs == pytest.approx(np.array([[d / 5, d / 5, 2 * d / 10] for d in (2, 3, 4, 5)]))
    assert rows.teacher == pytest.approx(np.array([4, 3, 2, 1]) * TICK_S / 20)
    # 1 m a tick is 2 m/s: 3, 2, 1 and 0 m to go.
    assert rows.direct == pytest.approx(np.array([1.5, 1.0, 0.5, 0.0]) / 20)


def test_what_is_lost_later_than_20_s_is_left_out() -> None:
    trace = run()
    rows = rows_of(trace, found(trace), tick_s=8.0, range_m=RANGE_M)
    assert rows.teacher == pytest.approx(np.array([16.0, 8.0]) / 20)
