"""The learned prediction: inputs and forward pass by hand, symmetry, and how the rules use it."""

from __future__ import annotations

from itertools import combinations, permutations
from math import exp, log

import pytest
from hypothesis import given
from hypothesis import strategies as st

from swarm_agent.bcmommt.belief import FAR, NOBODY
from swarm_agent.bcmommt.loss import predict_losses
from swarm_agent.bcmommt.net import BLANK, Net, forward, pair_inputs, sigmoid, triple_inputs
from swarm_agent.bcmommt.params import Params, Predictor
from swarm_agent.bcmommt.tags import claim_tags
from tests.swarm_agent.bcmommt.scene import NOW, params, sense, table

# One hidden neuron for every net: 20 s x sigmoid(sigmoid(0) x 0 + bias).
TEN_S, FIVE_S = Net(((0.0,) * 5,), 0.0), Net(((0.0,) * 8,), -log(3.0))
LEARNED = params(predictor=Predictor.LEARNED, pair_net=TEN_S, triple_net=FIVE_S)
PAIR = ((2.0, 0.0, 0.3, 0.0), (-2.0, 0.0, -0.3, 0.0))
lengths = st.floats(0.0, 11.0)


def losses(p: Params, *targets: tuple[float, float, float, float]) -> list[float]:
    t = table(len(targets))
    for j, (x, y, vx, vy) in enumerate(targets):
        sense(t, j, x, y, vx, vy)
    predict_losses(t, p, claim_tags(t, p, 1, NOBODY, NOW))
    return list(t.loss_in_s)


def test_sigmoid() -> None:
    assert sigmoid(0.0) == 0.5
    assert sigmoid(log(3.0)) == pytest.approx(0.75)
    assert sigmoid(-1e9) == pytest.approx(0.0, abs=1e-15)
    assert sigmoid(1e9) == pytest.approx(1.0, abs=1e-15)


def test_forward_by_hand() -> None:
    # First neuron: 2 x .5 - 1 x .25 - .75 = 0, sigmoid .5. Second: 0 x .5 + 4 x .25 + log 3 - 1 = log 3, sigmoid .75.
    net = Net(((2.0, -1.0, -0.75, 6.0), (0.0, 4.0, log(3.0) - 1.0, -4.0)), 1.0)
    assert forward(net, (0.5, 0.25)) == pytest.approx(1.0 / (1.0 + exp(-(6.0 * 0.5 - 4.0 * 0.75 + 1.0))))
    assert forward(BLANK, (0.1,) * 6) == 0.5


def test_the_papers_inputs() -> None:
    # d / r_s, d / r_s, dd / (2 r_s); the nearer first.
    assert pair_inputs(5.5, 2.75, 3.3, 5.5) == pytest.approx((0.5, 1.0, 0.3))
    # Of three, by distance: of each, the gap between the other two.
    assert triple_inputs(3.0, 1.0, 2.0, 0.8, 0.6, 0.4, 4.0) == pytest.approx((0.25, 0.5, 0.75, 0.075, 0.1, 0.05))


@given(st.lists(lengths, min_size=3, max_size=3), st.lists(lengths, min_size=3, max_size=3))
def test_the_order_of_three_does_not_matter(distances: list[float], opposite: list[float]) -> None:
    def inputs(order: tuple[int, ...]) -> tuple[float, ...]:
        # The gap between two is that opposite of the third.
        gaps = [opposite[order[3 - a - b]] for a, b in combinations(range(3), 2)]
        return triple_inputs(*(distances[i] for i in order), *gaps, 5.5)  # type: ignore[arg-type]

    assert len({inputs(order) for order in permutations(range(3))}) == 1


@given(lengths, lengths, lengths)
def test_the_order_of_two_does_not_matter(a: float, b: float, gap: float) -> None:
    assert pair_inputs(a, b, gap, 5.5) == pair_inputs(b, a, gap, 5.5)


def test_the_net_for_two_and_the_net_for_three_speak_for_all_tags() -> None:
    assert losses(LEARNED, *PAIR) == pytest.approx([10.0, 10.0])
    assert losses(LEARNED, *PAIR, (0.0, 1.0, 0.0, 0.0)) == pytest.approx([5.0, 5.0, 5.0])


def test_beyond_three_tags_eq_10_speaks_and_of_one_nobody() -> None:
    four = (*PAIR, (0.0, 1.0, 0.0, 0.3), (0.0, -1.0, 0.0, -0.3))
    direct = losses(params(predictor=Predictor.DIRECT), *four)
    assert losses(LEARNED, *four) == direct
    assert direct[:2] == pytest.approx([35 / 3, 35 / 3])
    assert losses(LEARNED, PAIR[0]) == [FAR]


def test_beyond_the_horizon_the_net_foresees_nothing() -> None:
    assert losses(LEARNED._replace(horizon_s=9.0), *PAIR) == [FAR, FAR]
