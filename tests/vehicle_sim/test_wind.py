"""The air is a pure function of seed, vehicle and time."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_sim.wind import LocalWind, Wind


def test_wind_from_the_west_blows_east() -> None:
    north, east = LocalWind(Wind(speed_m_s=5.0, from_deg=270.0), seed=1, who=1).at(12.3)
    assert (north, east) == (pytest.approx(0.0, abs=1e-12), pytest.approx(5.0))


@given(times=st.lists(st.floats(0.0, 1e5), min_size=1, max_size=10), seed=st.integers(0, 2**32 - 1))
def test_gusts_are_bounded_and_do_not_depend_on_who_asked_before(times: list[float], seed: int) -> None:
    wind = Wind(speed_m_s=4.0, from_deg=0.0, gust_m_s=2.0)
    asked_often = LocalWind(wind, seed=seed, who=3)
    for time_s in times:
        north, east = asked_often.at(time_s)
        assert (north, east) == LocalWind(wind, seed=seed, who=3).at(time_s)
        assert -6.0 <= north <= -2.0
        assert -2.0 <= east <= 2.0


def test_gusts_have_no_jumps_and_differ_between_vehicles() -> None:
    wind = Wind(gust_m_s=3.0)
    one, other = LocalWind(wind, seed=5, who=1), LocalWind(wind, seed=5, who=2)
    trace = [one.at(0.01 * k) for k in range(2000)]
    assert max(abs(b[0] - a[0]) for a, b in pairwise(trace)) <= 0.061  # 6 m/s over a second
    assert trace != [other.at(0.01 * k) for k in range(2000)]


@pytest.mark.parametrize("wrong", [{"speed_m_s": -1.0}, {"gust_m_s": float("nan")}, {"from_deg": float("inf")}])
def test_impossible_wind_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=r"wind\."):
        Wind(**wrong)
