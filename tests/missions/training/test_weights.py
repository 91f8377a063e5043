"""The weights file and the bundled nets: what is read, what is refused, and that the nets make sense."""

from __future__ import annotations

import sys
from math import sqrt
from pathlib import Path
from subprocess import run

import pytest

from missions import compose
from missions.load import load_mission
from missions.overrides import Override
from missions.problems import InputError, MissionError
from missions.training.weights import BUNDLED, read_weights, write_weights
from swarm_agent.bcmommt.net import BLANK, TAUGHT_S, forward, pair_inputs, triple_inputs
from swarm_agent.bcmommt.params import Predictor

WEIGHTS = read_weights(BUNDLED)
PAIR, TRIPLE = WEIGHTS.pair.net, WEIGHTS.triple.net
OUTWARD = [0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0]


def test_written_and_read_again(tmp_path: Path) -> None:
    path = tmp_path / "w.json"
    write_weights(path, WEIGHTS)
    assert read_weights(path) == WEIGHTS
    assert path.read_bytes() == BUNDLED.read_bytes()


def test_a_pair_that_flees_apart_is_lost_the_sooner_the_further_out_it_is() -> None:
    seconds = [TAUGHT_S * forward(PAIR, pair_inputs(d, d, 2.0 * d, 1.0)) for d in OUTWARD]
    assert seconds == sorted(seconds, reverse=True)
    assert seconds[0] > 12.0
    assert seconds[-1] < 1.0
    # Straight away from each other at 0.3 m/s within 5.5 m there is an exact answer.
    assert seconds == pytest.approx([(1.0 - d) * 5.5 / 0.3 for d in OUTWARD], abs=2.0)


def test_three_that_flee_apart_are_lost_the_sooner_the_further_out_they_are() -> None:
    seconds = [TAUGHT_S * forward(TRIPLE, triple_inputs(d, d, d, *(sqrt(3) * d,) * 3, 1.0)) for d in OUTWARD]
    assert seconds == sorted(seconds, reverse=True)
    assert seconds[-1] < 1.0


def test_a_mission_flies_the_bundled_weights_or_its_own(tmp_path: Path) -> None:
    learned = load_mission("quickstart", overrides=[Override("policy.predictor=learned")])
    params = compose.params(learned)
    assert (params.predictor, params.pair_net, params.triple_net) == (Predictor.LEARNED, PAIR, TRIPLE)
    own = WEIGHTS.__class__("swapped bias", WEIGHTS.pair.__class__(PAIR.hidden, 0.125), WEIGHTS.triple)
    write_weights(tmp_path / "own.json", own)
    (tmp_path / "m.yaml").write_text("name: m\npolicy: {predictor: learned, weights: own.json}\n", encoding="utf-8")
    assert compose.params(load_mission(str(tmp_path / "m.yaml"))).pair_net.bias == 0.125
    assert compose.params(load_mission("quickstart")).pair_net == BLANK


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "malformed"),
        ("{}", "missing required field"),
        ('{"about": "", "pair": {"hidden": [], "bias": 0}, "triple": {"hidden": [], "bias": 0}}', "at least one"),
        (BUNDLED.read_text().replace('"triple"', '"tripel"'), "tripel"),
        (BUNDLED.read_text().replace('"pair"', '"x"').replace('"triple"', '"pair"').replace('"x"', '"triple"'), "pair"),
    ],
    ids=["empty", "nothing in it", "no neurons", "misspelled", "nets exchanged"],
)
def test_other_files_are_refused(tmp_path: Path, text: str, why: str) -> None:
    path = tmp_path / "w.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_weights(path)
    assert str(path) in str(error.value)
    assert "swarm train" in str(error.value)
    assert why in str(error.value) or why == "malformed"
    with pytest.raises(MissionError, match=r"policy\.weights: got .*allowed: null, or a weights file of swarm train"):
        load_mission("quickstart", overrides=[Override(f"policy.weights={path}")])


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(MissionError, match=r"policy\.weights: got .*No such file"):
        load_mission("quickstart", overrides=[Override(f"policy.weights={tmp_path / 'none.json'}")])


def test_weights_are_read_without_torch_numpy_and_numba() -> None:
    code = (
        "import sys, missions.compose, missions.training.weights; print(*{'torch','numpy','numba'} & set(sys.modules))"
    )
    assert run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == ""
