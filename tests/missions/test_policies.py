"""Every policy flies a whole mission, and is named in its report."""

from __future__ import annotations

from typing import get_args

import pytest

from comms.clock import Lockstep
from comms.session import open_local_bus
from missions.compose import params
from missions.flight import Flight
from missions.load import load_mission
from missions.metrics import Metrics
from missions.mission import Mission, Policy
from missions.overrides import Override
from missions.report import make_report
from swarm_agent.bcmommt import params as rules

NAMES = get_args(Policy.model_fields["name"].annotation)
SHORT = ("agents.count=4", "duration_s=15", "vehicle.boot_s=0.5", "agents.altitude.base_m=4")


def mission(name: str, *changes: str) -> Mission:
    return load_mission("narrow", overrides=[Override(text) for text in (*SHORT, f"policy.name={name}", *changes)])


def test_every_name_is_a_policy_of_its_own() -> None:
    assert {params(mission(name)).policy for name in NAMES} == set(rules.Policy)


@pytest.mark.parametrize("name", NAMES)
def test_every_policy_flies(name: str) -> None:
    metrics = Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission(name, "targets.count=6"), bus)
        flight.run(pace=Lockstep(), observers=[metrics], stop=lambda: False)
    report = make_report(flight.side, metrics, wall_s=1.0, recording=None)
    assert flight.complete
    assert report["faults"] == []
    assert report["policy"] == name
    assert report["coverage"] > 0.7  # four agents and six targets within 5 m: they cannot lose many in 15 s
    assert (report["help"]["calls"] > 0) <= name.startswith("b-cmommt")
