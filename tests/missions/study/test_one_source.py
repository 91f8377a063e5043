"""One source: a mission in the air, with ideal vehicle and radio, equals the same mission compiled, bit by bit."""

from __future__ import annotations

from dataclasses import astuple
from typing import Any

import pytest

from comms.clock import Lockstep
from comms.session import open_local_bus
from missions.flight import Flight
from missions.load import load_mission
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observation
from missions.overrides import Override

np = pytest.importorskip("numpy")
pytest.importorskip("numba")

AS_PRINTED = (
    "policy={call: predicted, answer_gate: in_time, capture: worst_case, help_margin_s: 2, memory_s: 0, horizon_s: 20}"
)


class Kept:
    """An observer that keeps the ticks of the mission proper."""

    def __init__(self) -> None:
        self.ticks: list[Observation] = []

    def observe(self, observation: Observation) -> None:
        if observation.mission_tick is not None:
            self.ticks.append(observation)


def ideal(name: str, *changes: str) -> Mission:
    return load_mission(name, overrides=[Override(t) for t in ("vehicle.kind=ideal", "radio.mode=ideal", *changes)])


def compare(mission: Mission) -> None:
    from missions.study.engine import trace

    kept, metrics = Kept(), Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.run(pace=Lockstep(), observers=[kept, metrics], stop=lambda: False)
    compiled = trace(mission, seed=mission.seed, start_tick=kept.ticks[0].tick)
    places = np.array([[truth.position_m[:2] for truth in tick.truths] for tick in kept.ticks])
    targets: Any = np.array([[(target.x_m, target.y_m) for target in tick.targets] for tick in kept.ticks])
    tags = np.array([[[j in s.tags for j in range(len(tick.targets))] for s in tick.statuses] for tick in kept.ticks])
    assert np.array_equal(compiled.agents, places)
    assert np.array_equal(compiled.targets, targets)
    assert np.array_equal(compiled.tagged, tags)
    assert compiled.seen.sum() / compiled.present.sum() == flight.coverage.mean
    assert tuple(compiled.events) == astuple(metrics.events)
    assert tuple(compiled.help) == astuple(metrics.help)


@pytest.mark.parametrize(
    "changes",
    [
        ("quickstart",),
        ("narrow", AS_PRINTED),
        ("crowded", "targets.motion=random"),
        ("narrow", "policy.explore=stale-first", "policy.commitment=false", "seed=7"),
        ("crowded", "agents.sensing.identity_error=0.3"),
        ("crowded", "agents.sensing={field_of_view: sector, opening_deg: 100}", "policy.explore=stale-first"),
        ("quickstart", "agents.sensing={field_of_view: camera, half_angle_deg: 14}", "policy.explore=stale-first"),
        ("quickstart", "agents.sensing={field_of_view: camera, identity_error: 0.1}", AS_PRINTED),
        ("crowded", "policy.predictor=learned", "policy.call=predicted"),
        ("quickstart", "policy.name=a-cmommt"),
        ("quickstart", "policy.name=b-cmommt-basic"),
        ("quickstart", "policy.name=regions"),
        ("quickstart", "tick_s=0.2", "arena={shape: rectangle, width_m: 40, height_m: 50}"),
    ],
    ids=lambda changes: " ".join(changes)[:40],
)
def test_flown_and_compiled_are_equal(changes: tuple[str, ...]) -> None:
    compare(ideal(*changes, "duration_s=40"))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 21))
def test_flown_and_compiled_are_equal_for_twenty_seeds(seed: int) -> None:
    compare(ideal("quickstart", f"seed={seed}"))
