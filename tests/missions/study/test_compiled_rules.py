"""On random tables the plain rules and the compiled ones decide the same."""

from __future__ import annotations

import copy
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

np = pytest.importorskip("numpy")
numba = pytest.importorskip("numba")

import missions.study.compiled.rules  # noqa: E402, F401  # makes the rules callable from compiled code
from swarm_agent.bcmommt.belief import NOBODY, Table  # noqa: E402
from swarm_agent.bcmommt.modes import Mode  # noqa: E402
from swarm_agent.bcmommt.net import Net  # noqa: E402
from swarm_agent.bcmommt.params import (  # noqa: E402
    Call,
    Capture,
    Explore,
    Gate,
    Params,
    Policy,
    Predictor,
)
from swarm_agent.bcmommt.step import Mind  # noqa: E402
from swarm_agent.policies.choice import decide  # noqa: E402
from tests.examples import MANY  # noqa: E402
from tests.swarm_agent.bcmommt.scene import NOW, params  # noqa: E402
from tests.swarm_agent.policies.test_choice import Scene, build, scenes  # noqa: E402

ME, SEED, TICK = 2, 1, 100
NET = Net(((0.7, -1.1, 2.0, 0.3, 0.4, -0.2, 0.9, -1.0), (-0.5, 1.4, 0.2, -1.3, 0.6, 0.1, -0.8, 1.2)), 0.1)
weights = {"pair_net": Net(tuple(row[:5] for row in NET.hidden), NET.bias), "triple_net": NET}

choices = st.fixed_dictionaries({
    "policy": st.sampled_from(Policy),
    "explore": st.sampled_from(Explore),
    "predictor": st.sampled_from([Predictor.NONE, Predictor.DIRECT, Predictor.LEARNED]),
    "call": st.sampled_from(Call),
    "gate": st.sampled_from(Gate),
    "capture": st.sampled_from(Capture),
    "commitment": st.booleans(),
    "memory_s": st.sampled_from([0.0, 60.0]),
    "standoff_m": st.sampled_from([0.0, 0.5]),
})  # fmt: skip


@numba.njit(error_model="numpy")
def compiled(t: Table, p: Params, helping: int, capture_s: float) -> Any:
    mode = Mode.EXPLORE if helping == NOBODY else Mode.HELP
    mind = Mind(mode, helping, capture_s, 1.0, 0.0, NOBODY, -1.0e9)
    return decide(t, p, mind, ME, 0.0, 0.0, NOW, SEED, TICK)


def with_arrays(t: Table) -> Table:
    """As a study has it: all rows are looked at."""
    columns = Table(*[np.array(column) for column in t])
    return columns._replace(known=np.arange(len(t.sensed)), mates=np.arange(len(t.mate_at_s)))


def with_array_nets(p: Params) -> Params:
    pair, triple = (Net(np.array(net.hidden), net.bias) for net in (p.pair_net, p.triple_net))
    return p._replace(pair_net=pair, triple_net=triple)


@MANY
@given(scenes, choices, st.sampled_from([NOBODY, 0, 3]), st.floats(0.5, 30.0))
def test_on_random_tables_both_decide_the_same(
    scene: Scene, chosen: dict[str, Any], helping: int, capture_s: float
) -> None:
    p = params(**chosen, **weights)
    plain = build(scene, p)
    arrays = with_arrays(copy.deepcopy(plain))
    mode = Mode.EXPLORE if helping == NOBODY else Mode.HELP
    mind, vx, vy = decide(
        plain, p, Mind(mode, helping, capture_s, 1.0, 0.0, NOBODY, -1.0e9), ME, 0.0, 0.0, NOW, SEED, TICK
    )
    twin, twin_vx, twin_vy = compiled(arrays, with_array_nets(p), helping, capture_s)
    assert (mind.mode, mind.helping, mind.goal) == (twin.mode, twin.helping, twin.goal)
    assert plain.tagged == list(arrays.tagged)
    assert plain.calling == list(arrays.calling)
    assert list(arrays.loss_in_s) == pytest.approx(plain.loss_in_s, abs=1e-9)
    assert (twin_vx, twin_vy) == pytest.approx((vx, vy), abs=1e-9)
    assert twin.capture_s == pytest.approx(mind.capture_s, abs=1e-9)
