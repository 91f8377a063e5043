"""Times of loss (eq. 10) and of capture (eq. 11, eq. 13) against hand-computed cases and brute force."""

from __future__ import annotations

from math import cos, sin, sqrt

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from swarm_agent.bcmommt.belief import FAR, NOBODY
from swarm_agent.bcmommt.loss import predict_losses, time_to_leave
from swarm_agent.bcmommt.params import Params, Predictor
from swarm_agent.bcmommt.reach import intercept_time, worst_case_time
from swarm_agent.bcmommt.tags import claim_tags
from tests.swarm_agent.bcmommt.scene import NOW, PAPER_WORLD, params, sense, table

P = PAPER_WORLD
within = st.floats(-5.0, 5.0)
slow = st.floats(-0.3, 0.3)
angles = st.floats(0.0, 6.28)


def losses(p: Params, *targets: tuple[float, float, float, float]) -> list[float]:
    t = table(len(targets))
    for j, (x, y, vx, vy) in enumerate(targets):
        sense(t, j, x, y, vx, vy)
    predict_losses(t, p, claim_tags(t, p, 1, NOBODY, NOW))
    return list(t.loss_in_s)


def test_a_pair_that_flees_apart_is_lost_when_half_its_gap_is_the_sensing_range() -> None:
    # Both 2 m from the center, 0.3 m/s outward: (5.5 - 2) / 0.3 s, the same for both (footnote to eq. 10).
    assert losses(P, (2, 0, 0.3, 0), (-2, 0, -0.3, 0)) == pytest.approx([35 / 3, 35 / 3])


def test_eq_10_by_hand_for_three() -> None:
    # Center (0, 1) at rest; the third is 2 m north of it and leaves at 0.2 m/s relative to the center.
    times = losses(P, (-3, 0, 0, -0.1), (3, 0, 0, -0.1), (0, 3, 0, 0.2))
    assert times[2] == pytest.approx(3.5 / 0.2)
    # The others start at (3, -1) from the center and drift south by 0.1 m/s: sqrt(9 + (1 + t/10)^2) = 5.5.
    far = 10 * (sqrt(5.5**2 - 9) - 1)
    assert far > P.horizon_s
    assert times[:2] == [FAR, FAR]


@pytest.mark.parametrize("p", [params(predictor=Predictor.NONE), P])
def test_a_single_tag_and_no_predictor_are_never_lost(p: Params) -> None:
    assert losses(p, (5.4, 0, 0.3, 0)) == [FAR]
    if p.predictor == Predictor.NONE:
        assert losses(p, (5, 0, 0.3, 0), (-5, 0, -0.3, 0)) == [FAR, FAR]


def test_beyond_the_horizon_nothing_is_foreseen() -> None:
    pair = ((0.5, 0, 0.1, 0), (-0.5, 0, -0.1, 0))
    assert losses(P, *pair) == [FAR, FAR]
    assert losses(params(horizon_s=60.0), *pair) == pytest.approx([50.0, 50.0])


@given(within, within, slow, slow, angles)
def test_leaving_does_not_depend_on_directions(x: float, y: float, vx: float, vy: float, angle: float) -> None:
    c, s = cos(angle), sin(angle)
    turned = time_to_leave(c * x - s * y, s * x + c * y, c * vx - s * vy, s * vx + c * vy, 5.5)
    plain = time_to_leave(x, y, vx, vy, 5.5)
    assume(plain < 1e6)
    assert turned == pytest.approx(plain, rel=1e-6, abs=1e-6)


@given(within, within, slow, slow)
def test_at_the_time_of_leaving_the_point_is_on_the_circle(x: float, y: float, vx: float, vy: float) -> None:
    after = time_to_leave(x, y, vx, vy, 5.5)
    assume(0.0 < after < 1e4)
    assert sqrt((x + after * vx) ** 2 + (y + after * vy) ** 2) == pytest.approx(5.5, abs=1e-6)
    earlier = 0.99 * after
    assert sqrt((x + earlier * vx) ** 2 + (y + earlier * vy) ** 2) < 5.5


@pytest.mark.parametrize(
    ("distance", "seconds"),
    [(0.0, 0.5), (5.5, 0.5), (5.6, 1.5), (7.5, 20.5), (15.5, 100.5)],  # eq. 13 with 0.4 - 0.3 m/s and delta 0.5 s
)
def test_eq_13(distance: float, seconds: float) -> None:
    assert worst_case_time(distance, P) == pytest.approx(seconds)


def test_eq_13_never_catches_what_is_not_slower() -> None:
    assert worst_case_time(6.0, params(target_speed_m_s=0.4)) == FAR


@pytest.mark.parametrize(
    ("dx", "vx", "seconds"),
    [
        (7.5, 0.3, 20.5 + 1.5),  # fleeing: the worst case, plus the 0.15 m it gains during the turn
        (7.5, 0.0, 0.5 + 2.0 / 0.4),
        (7.5, -0.3, 0.5 + (2.0 - 0.15) / 0.7),
        (5.0, 0.3, 0.5),
    ],
)
def test_eq_11_along_a_line(dx: float, vx: float, seconds: float) -> None:
    assert intercept_time(dx, 0.0, vx, 0.0, P) == pytest.approx(seconds)


@given(st.floats(-30, 30), st.floats(-30, 30), slow, slow)
def test_eq_11_against_a_referee_that_tries_every_moment(dx: float, dy: float, vx: float, vy: float) -> None:
    def in_sight(t: float) -> bool:
        x, y = dx + vx * t, dy + vy * t
        return sqrt(x * x + y * y) <= P.sensing_range_m + P.agent_speed_m_s * max(0.0, t - P.turn_time_s)

    answer = intercept_time(dx, dy, vx, vy, P)
    assume(answer < 400.0)
    assert in_sight(answer + 1e-6)
    tried = [0.5 + 0.05 * k for k in range(int((answer - 0.5) / 0.05))]
    assert not any(in_sight(t) for t in tried if t < answer - 1e-6)


def test_eq_11_gives_up_on_what_outruns_the_helper() -> None:
    assert intercept_time(10.0, 0.0, 0.5, 0.0, P) == FAR
    assert intercept_time(10.0, 0.0, 0.4, 0.0, P) == FAR
    assert intercept_time(10.0, 0.0, -0.4, 0.0, P) == pytest.approx(0.5 + (4.5 - 0.2) / 0.8)
