"""A-CMOMMT: forces by hand, in the paper's world (r_s 5.5: d_o2 1.76, predictive 6.6, d_r1 2.75, d_r2 4.4 m)."""

from __future__ import annotations

from math import hypot

import pytest

from swarm_agent.bcmommt.belief import NOBODY, Table, hear_mate, hear_position
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.step import Mind, new_mind
from swarm_agent.policies.a_cmommt import decide, force, mate_force, target_force
from tests.swarm_agent.bcmommt.scene import NOW, PAPER_WORLD, claim, params, sense, table

P = PAPER_WORLD
ME = 2


def act(t: Table, standoff_m: float = 0.0) -> tuple[Mind, float, float]:
    return decide(t, params(standoff_m=standoff_m), new_mind(1.0, 0.0), ME, 0.0, 0.0, NOW, 1, 100)


def mate_at(t: Table, mate: int, x: float, y: float, age: float = 0.1) -> None:
    hear_mate(t, mate, x, y, NOW - age)


def test_targets_draw_by_direction_and_profile() -> None:
    t = table()
    sense(t, 0, 3.0, 4.0)  # full pull
    sense(t, 1, 0.0, -0.88)  # half
    assert target_force(t, P, 0.0, 0.0, NOW) == pytest.approx((2, 0.6, 0.8 - 0.5))


def test_a_target_that_a_mate_observes_counts_a_quarter() -> None:
    t = table()
    sense(t, 0, 3.0, 4.0)
    claim(t, 0, 1, 5.0)  # not even nearer
    assert target_force(t, P, 0.0, 0.0, NOW) == pytest.approx((1, 0.15, 0.2))
    assert target_force(t, P, 0.0, 0.0, NOW + 1.0)[1:] == pytest.approx((0.6, 0.8))  # the claim has run out


def test_predicted_targets_draw_within_the_predictive_range_and_a_mates_a_quarter() -> None:
    t = table()
    hear_position(t, 0, 0.0, 6.05, 0.0, 0.0, NOW - 5.0)  # lost from sight: half way from d_o3 to the end
    assert target_force(t, P, 0.0, 0.0, NOW) == pytest.approx((1, 0.0, 0.5))
    hear_position(t, 1, -6.05, 0.0, 0.0, 0.0, NOW - 0.1)
    claim(t, 1, 3, 2.0)
    assert target_force(t, P, 0.0, 0.0, NOW) == pytest.approx((2, -0.125, 0.5))
    hear_position(t, 2, 7.0, 0.0, 0.0, 0.0, NOW - 0.1)  # too far
    assert target_force(t, P, 0.0, 0.0, NOW)[0] == 2


def test_mates_push_unless_far_or_not_heard_for_long() -> None:
    t = table()
    mate_at(t, 0, 2.0, 0.0)  # in full
    mate_at(t, 1, 0.0, 3.575)  # half
    mate_at(t, 3, -4.5, 0.0)
    mate_at(t, 4, -1.0, 0.0, age=2.5)
    assert mate_force(t, P, 0.0, 0.0, NOW) == pytest.approx((-1.0, -0.5))


def test_equation_2_is_the_sum_and_the_velocity_its_capped_multiple() -> None:
    t = table()
    sense(t, 0, 0.0, 0.528)  # 0.3
    mate_at(t, 0, -4.07, 0.0)  # 0.2
    assert force(t, P, 0.0, 0.0, NOW) == pytest.approx((1, 0.2, 0.3))
    mind, vx, vy = act(t)
    assert mind.mode is Mode.FOLLOW
    assert (vx, vy) == pytest.approx((0.2, 0.3))
    sense(t, 1, 0.0, 4.0)
    _, vx, vy = act(t)
    assert hypot(vx, vy) == pytest.approx(0.4)
    assert vx / vy == pytest.approx(0.2 / 1.3)


def test_only_a_standoff_makes_targets_push() -> None:
    t = table()
    sense(t, 0, 0.2, 0.0)
    assert act(t)[1] == pytest.approx(0.2 / 1.76)
    assert act(t, standoff_m=0.25)[1] == pytest.approx(-0.2)


def test_right_above_a_target_or_a_mate_there_is_no_force() -> None:
    t = table()
    sense(t, 0, 0.0, 0.0)
    mate_at(t, 0, 0.0, 0.0)
    assert act(t)[1:] == (0.0, 0.0)


def test_the_whole_sight_is_told_and_nobody_is_called() -> None:
    t = table()
    sense(t, 0, 1.0, 0.0)
    sense(t, 3, -4.0, 0.0)
    claim(t, 3, 0, 1.0)  # nearer, but nobody owns a target
    mind, _, _ = act(t)
    assert t.tagged == [True, False, False, True]
    assert not any(t.calling)
    assert mind.helping == NOBODY


def test_with_nothing_to_draw_it_the_agent_explores() -> None:
    t = table()
    hear_position(t, 0, 7.0, 0.0, 0.0, 0.0, NOW - 0.1)
    mind, vx, vy = act(t)
    assert mind.mode is Mode.EXPLORE
    assert hypot(vx, vy) == pytest.approx(0.4)
