"""Figure 1 as tables to check with the paper in hand, the following distance of eq. 12, and who is predicted."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from swarm_agent.bcmommt.belief import FAR, hear_position
from swarm_agent.bcmommt.prediction import in_predictive_tracking, predicted_distance
from swarm_agent.bcmommt.profiles import agent_factor, full_pull_m, greatest_standoff_m, target_factor
from tests.swarm_agent.bcmommt.scene import NOW, params, sense, table

# With r_s = 25 the distances are those of public re-implementations.
WITH_STANDOFF = params(sensing_range_m=25.0, standoff_m=4.0)  # d_o1 4, d_o2 8, d_o3 25, predictive 30
RIGHT_ABOVE = params(sensing_range_m=25.0, standoff_m=0.0)
distances = st.floats(0.0, 40.0)


@pytest.mark.parametrize(
    ("distance", "factor"),
    [(0, -1), (2, -0.5), (4, 0), (6, 0.5), (8, 1), (15, 1), (25, 1), (27.5, 0.5), (29, 0.2), (30, 0), (99, 0)],
)
def test_targets_push_when_too_near_and_draw_further_off(distance: float, factor: float) -> None:
    assert target_factor(WITH_STANDOFF, distance) == pytest.approx(factor)


@pytest.mark.parametrize(
    ("distance", "factor"), [(0, 0), (2, 0.25), (4, 0.5), (8, 1), (25, 1), (27.5, 0.5), (30, 0), (99, 0)]
)
def test_without_a_standoff_targets_only_draw(distance: float, factor: float) -> None:
    assert target_factor(RIGHT_ABOVE, distance) == pytest.approx(factor)


@pytest.mark.parametrize(
    ("distance", "factor"), [(0, -1), (12.5, -1), (16.25, -0.5), (18.5, -0.2), (20, 0), (25, 0), (99, 0)]
)
def test_mates_only_push(distance: float, factor: float) -> None:
    assert agent_factor(WITH_STANDOFF, distance) == pytest.approx(factor)


@pytest.mark.parametrize(("standoff", "full_pull"), [(0, 8), (4, 8), (6, 10), (20, 24), (23, 25), (24.9, 25)])
def test_a_wide_standoff_moves_the_full_pull_outward(standoff: float, full_pull: float) -> None:
    assert full_pull_m(params(sensing_range_m=25.0, standoff_m=standoff)) == pytest.approx(full_pull)


@given(distances, st.floats(0.0, 24.0))
def test_profiles_are_at_most_1_and_continuous(distance: float, standoff: float) -> None:
    p = params(sensing_range_m=25.0, standoff_m=standoff)
    for factor in (target_factor, agent_factor):
        assert abs(factor(p, distance)) <= 1.0
    if standoff > 1e-3:  # else the push of the last micrometers is too steep to tell from a step
        assert target_factor(p, distance + 1e-9) == pytest.approx(target_factor(p, distance), abs=1e-5)
    assert agent_factor(p, distance + 1e-9) == pytest.approx(agent_factor(p, distance), abs=1e-5)


def test_equation_12() -> None:
    at_once = params(turn_time_s=0.0)
    assert [greatest_standoff_m(at_once, r) for r in (0, 1, 2, 10)] == pytest.approx([2.75, 1.375, 5.5 / 6, 0.25])
    assert greatest_standoff_m(params(), 1) == pytest.approx(1.375 - 0.4 * 0.5)
    assert greatest_standoff_m(params(), 20) < 0.0


@given(st.integers(1, 50), st.floats(0.0, 2.0))
def test_with_equation_12_a_lost_target_is_still_in_sight_of_who_lost_it(robots: int, turn_time_s: float) -> None:
    p = params(turn_time_s=turn_time_s)
    xi = p.agent_speed_m_s * turn_time_s
    eq_14 = robots / (robots + 1) * p.sensing_range_m - xi
    assert 2 * robots * greatest_standoff_m(p, robots) <= eq_14 + 1e-9


def test_predicted_are_targets_beyond_sight_and_only_for_a_while() -> None:
    t = table()
    sense(t, 0, 6.0, 0.0)
    hear_position(t, 1, 5.6, 0.0, 0.2, 0.0, NOW - 2.0)  # at 6.0 m now
    hear_position(t, 2, 5.6, 0.0, -0.2, 0.0, NOW - 2.0)  # at 5.2 m: should be in sight
    hear_position(t, 3, 6.0, 0.0, 0.0, 0.0, NOW - 20.1)
    assert [predicted_distance(t, params(), j, 0.0, 0.0, NOW) for j in range(4)] == pytest.approx([FAR, 6.0, FAR, FAR])
    hear_position(t, 3, 6.7, 0.0, 0.0, 0.0, NOW - 0.1)
    assert [in_predictive_tracking(t, params(), j, 0.0, 0.0, NOW) for j in range(4)] == [False, True, False, False]
    assert predicted_distance(t, params(), 3, 0.0, 0.0, NOW) == pytest.approx(6.7)  # beyond 1.2 r_s, but known
