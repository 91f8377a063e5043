"""What every policy promises, whatever an agent knows; and that each is reached by its number."""

from __future__ import annotations

from math import cos, hypot, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from swarm_agent.bcmommt import step
from swarm_agent.bcmommt.belief import NOBODY, Table, cell_columns, cell_rows, hear_call, hear_mate, hear_position
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Explore, Params, Policy
from swarm_agent.bcmommt.step import Mind, new_mind
from swarm_agent.policies import a_cmommt, basic, regions
from swarm_agent.policies.choice import decide
from tests.examples import MANY
from tests.swarm_agent.bcmommt.scene import LAST_TICK, NOW, PAPER_WORLD, claim, params, sense, table

ME = 2
RULES = {
    Policy.A_CMOMMT: a_cmommt.decide,
    Policy.B_CMOMMT_BASIC: basic.decide,
    Policy.B_CMOMMT: step.decide,
    Policy.REGIONS: regions.decide,
}
Spot = tuple[float, float, float, float]
Scene = tuple[list[tuple[str, Spot]], list[Spot | None]]
coordinate = st.floats(-5.4, 5.4).map(lambda x: round(x, 3))
velocity = st.floats(-0.3, 0.3).map(lambda v: round(v, 3))
spot = st.tuples(coordinate, coordinate, velocity, velocity)
# Per target: sensed, else told of by mate 1, who calls for it or claims it, else lost a moment ago; farther off.
target = st.tuples(st.sampled_from(["sensed", "shared", "called", "claimed", "lost", "unknown"]), spot)
scenes = st.tuples(st.lists(target, min_size=5, max_size=5), st.lists(st.none() | spot, min_size=2, max_size=2))


def turned(x: float, y: float, angle: float) -> tuple[float, float]:
    return cos(angle) * x - sin(angle) * y, sin(angle) * x + cos(angle) * y


def build(
    scene: Scene,
    p: Params,
    angle: float = 0.0,
) -> Table:
    targets, mates = scene
    t = table(n_targets=5, n_cells=cell_columns(p) * cell_rows(p))
    for mate, place in enumerate(mates):
        if place is not None:
            hear_mate(t, mate, *turned(place[0], place[1], angle), LAST_TICK)
    for j, (kind, (x, y, vx, vy)) in enumerate(targets):
        heading = turned(vx, vy, angle)
        if kind in ("sensed", "shared"):
            sense(t, j, *turned(x, y, angle), *heading)
            if kind == "shared":
                claim(t, j, 1, 2.0)
        elif kind != "unknown":
            farther = 1.501 + 0.013 * j  # no two at the same distance, none right on the edge of a range
            hear_position(t, j, *turned(farther * x, farther * y, angle), *heading, LAST_TICK)
            t.tagged[j] = kind == "lost"
            if kind == "claimed":
                claim(t, j, 1, 2.0)
            if kind == "called":
                hear_call(t, p, j, 1, NOW + 5.0, LAST_TICK)
    return t


def act(t: Table, p: Params, heading: float = 0.0) -> tuple[Mind, float, float]:
    return decide(t, p, new_mind(*turned(1.0, 0.0, heading)), ME, 0.0, 0.0, NOW, 1, 100)


@MANY
@given(scenes, st.sampled_from(Policy), st.sampled_from(Explore), st.sampled_from([0.0, 0.5]))
def test_laws_of_every_policy(scene: Scene, policy: Policy, explore: Explore, standoff: float) -> None:
    p = params(policy=policy, explore=explore, standoff_m=standoff)
    t = build(scene, p)
    mind, vx, vy = act(t, p)
    assert hypot(vx, vy) <= p.agent_speed_m_s + 1e-9
    assert (mind.mode is Mode.FOLLOW) == any(t.tagged)
    assert (mind.mode is Mode.HELP) == (mind.helping != NOBODY)
    assert not any(tagged and not sensed for tagged, sensed in zip(t.tagged, t.sensed, strict=True))
    assert hypot(mind.heading_x, mind.heading_y) == pytest.approx(1.0)
    assert all(seconds >= 0.0 for seconds in t.loss_in_s)


@MANY
@given(scenes, st.sampled_from([Policy.A_CMOMMT, Policy.B_CMOMMT_BASIC, Policy.B_CMOMMT]), st.floats(0, 6.28))
def test_turning_the_world_turns_the_decision(scene: Scene, policy: Policy, angle: float) -> None:
    p = params(policy=policy)
    here, there = build(scene, p), build(scene, p, angle)
    mind, vx, vy = act(here, p)
    turned_mind, wx, wy = act(there, p, angle)
    assert (turned_mind.mode, turned_mind.helping) == (mind.mode, mind.helping)
    assert (wx, wy) == pytest.approx(turned(vx, vy, angle), abs=1e-6)


@pytest.mark.parametrize("quarters", [1, 2, 3])
@given(scenes)
def test_regions_turn_with_the_world_in_quarters(quarters: int, scene: Scene) -> None:
    p, angle = params(policy=Policy.REGIONS), quarters * 1.5707963267948966
    _, vx, vy = act(build(scene, p), p)
    _, wx, wy = act(build(scene, p, angle), p, angle)
    assert (wx, wy) == pytest.approx(turned(vx, vy, angle), abs=1e-6)


@pytest.mark.parametrize("policy", Policy)
def test_each_policy_is_reached_by_its_number(policy: Policy) -> None:
    """Two targets in sight, one far and shared with a mate close by: no two policies fly the same way."""
    scene = (
        [("sensed", (1.0, 0.5, 0.1, 0.0)), ("shared", (-4.0, 2.0, 0.0, 0.1)), ("sensed", (0.2, -0.9, 0.0, 0.0))]
        + [("unknown", (0.0, 0.0, 0.0, 0.0))] * 2,
        [(1.0, 1.0, 0.0, 0.0), None],
    )
    p = PAPER_WORLD._replace(policy=policy)
    t, same = build(scene, p), build(scene, p)
    expected = RULES[policy](same, p, new_mind(1.0, 0.0), ME, 0.0, 0.0, NOW, 1, 100)
    assert act(t, p) == expected
    assert t == same


def test_another_number_is_another_decision() -> None:
    """A lost target, a call and a claim: force, own call, answer and region lead four different ways."""
    scene = (
        [
            ("called", (-5.0, 3.0, 0.0, 0.0)),
            ("lost", (4.0, 0.0, 0.0, 0.0)),
            ("claimed", (0.0, -4.0, 0.0, 0.0)),
            ("unknown", (0.0, 0.0, 0.0, 0.0)),
            ("unknown", (0.0, 0.0, 0.0, 0.0)),
        ],
        [None, (-3.0, 0.0, 0.0, 0.0)],
    )
    flights = {act(build(scene, params(policy=policy)), params(policy=policy))[1:] for policy in Policy}
    assert len(flights) == len(Policy)
