"""More agents than MAVLink has system ids, and more than a person would start by hand."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from comms.clock import Lockstep
from comms.session import open_local_bus
from missions.flight import Flight
from missions.ground_link import open_ground_link
from missions.load import load_mission
from missions.metrics import Metrics
from missions.mission import MOST_SYSTEMS
from missions.overrides import Override
from missions.problems import InputError
from missions.report import make_report
from tests.missions.daemons.swarm import free_endpoint, swarm

LARGE = {
    "agents.count": MOST_SYSTEMS + 2,
    "targets.count": 50,
    "arena.radius_m": 100,
    "agents.deployment.radius_m": 60,
    "targets.deployment.radius_m": 60,
    "agents.altitude.base_m": 2,
    "agents.altitude.layers": 1,
    "vehicle.kind": "ideal",
    "vehicle.boot_s": 0.1,
    "duration_s": 2,
}
HUNDRED = LARGE | {"agents.count": 100, "vehicle.kind": "simulated"}


@pytest.mark.slow
def test_more_agents_than_mavlink_has_systems_fly_ideal_vehicles() -> None:
    mission = load_mission("quickstart", overrides=[Override(f"{key}={value}") for key, value in LARGE.items()])
    with open_local_bus() as bus:
        flight, metrics = Flight(mission, bus), Metrics()
        with (
            pytest.raises(InputError, match=r"--gcs: got a swarm of 252; allowed: at most 250 on one port"),
            open_ground_link("udpout:127.0.0.1:1", flight.vehicles, option="--gcs"),  # type: ignore[arg-type]
        ):
            pass
        flight.run(pace=Lockstep(), observers=[metrics], stop=lambda: False)
    report = make_report(flight.side, metrics, wall_s=1.0, recording=None)
    assert flight.complete
    assert report["faults"] == []
    assert report["radio"]["sent"] == 20 * mission.agents.count
    assert report["radio"]["sent"] * (mission.agents.count - 1) == sum(
        report["radio"][key] for key in ("delivered", "out_of_range", "lost")
    )


def report_of(folder: Path, *words: str) -> dict[str, Any]:
    file = folder / f"report{len(words)}.json"
    changes = [word for key, value in HUNDRED.items() for word in ("--set", f"{key}={value}")]
    with swarm("launch", "quickstart", *changes, "--report", str(file), *words) as run:
        assert run.wait() == 0, run.output
    report: dict[str, Any] = json.loads(file.read_text())
    del report["timing"], report["recording"]
    return report


@pytest.mark.slow
def test_a_hundred_agents_in_four_workers_decide_as_in_one_process(tmp_path: Path) -> None:
    many = report_of(tmp_path, "--processes", "25", "--listen", free_endpoint())
    assert many == report_of(tmp_path)
    assert many["agents"] == 100
