"""Fitting: the scalar forward pass is torch's, errors fall, a seed repeats."""

from __future__ import annotations

import random

import pytest

np = pytest.importorskip("numpy")
pytest.importorskip("numba")
torch = pytest.importorskip("torch")

from missions.training.fit import as_module, fit, predict  # noqa: E402
from missions.training.rows import Rows  # noqa: E402
from missions.training.train import PAPER_MSE, Split, learn, table  # noqa: E402
from missions.training.weights import BUNDLED, read_weights  # noqa: E402
from swarm_agent.bcmommt.net import Net, forward  # noqa: E402

WEIGHTS = read_weights(BUNDLED)


@pytest.mark.parametrize("net", [WEIGHTS.pair.net, WEIGHTS.triple.net], ids=["pair", "triple"])
def test_plain_numbers_and_torch_say_the_same(net: Net) -> None:
    chance = random.Random(1)
    rows = [tuple(chance.random() for _ in range(len(net.hidden[0]) - 2)) for _ in range(200)]
    assert [forward(net, row) for row in rows] == pytest.approx(list(predict(net, np.array(rows))), abs=1e-9)


def test_there_and_back() -> None:
    module = as_module(WEIGHTS.pair.net)
    assert [tuple(parameter.shape) for parameter in module.parameters()] == [(6, 3), (6,), (1, 6), (1,)]


def rows(count: int, first: int = 0, n_inputs: int = 3) -> Rows:
    """The further out, the sooner lost; eq. 10 says half of it."""
    chance = random.Random(first)
    inputs = np.array([[chance.random() for _ in range(n_inputs)] for _ in range(count)])
    teacher = (1.0 - inputs.mean(axis=1)) ** 2
    return Rows(inputs, teacher, teacher / 2, situations=count // 10)


def test_fitting_lowers_the_error_on_what_it_has_not_seen() -> None:
    split = Split(rows(200), rows(50, first=1))
    lesson = learn(split, n_hidden=6, seed=3)
    begun = fit(split.fitted.inputs, split.fitted.teacher, n_hidden=6, seed=3, steps=1)
    before = float(np.mean((predict(begun, split.held_out.inputs) - split.held_out.teacher) ** 2))
    assert lesson.net_mse[1] < 0.01 * before
    assert lesson.net_mse[1] < 0.01 * lesson.mean_mse[1]
    assert lesson.direct_mse == pytest.approx([np.mean(r.teacher**2) / 4 for r in split])


def test_one_seed_one_net() -> None:
    some = rows(60)
    nets = [fit(some.inputs, some.teacher, n_hidden=4, seed=seed, steps=20) for seed in (5, 5, 6)]
    assert nets[0] == nets[1] != nets[2]


def test_the_table_tells_errors_beside_the_papers() -> None:
    lessons = {2: learn(Split(rows(60), rows(20, 1)), n_hidden=6, seed=1)}
    lessons[3] = learn(Split(rows(60, 2, 6), rows(20, 3, 6)), n_hidden=8, seed=1)
    text = table(lessons)
    assert f"{PAPER_MSE:.7f}" in text
    assert f"{lessons[2].net_mse[1]:.7f}" in text
    assert "3-6-1" in text
    assert "6-8-1" in text
    assert "6 + 2" in text  # situations, fitted and held out
