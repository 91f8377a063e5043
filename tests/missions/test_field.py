"""Missions whose agents hear each other directly: the same decisions as by an ideal air without an end."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import pytest

from comms.clock import Lockstep
from comms.session import open_local_bus
from comms.sight import decode_sight
from missions.faults.costs import Costs
from missions.flight import Flight
from missions.load import load_mission, parse_mission
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observation
from missions.overrides import Override
from missions.problems import MissionError
from missions.report import make_report

FAULTS = (
    "faults=[{kind: kill, at_s: 4, for_s: 5, agents: [1]}, {kind: freeze, at_s: 6, for_s: 4, agents: [2]}, "
    "{kind: kill, at_s: 12, agents: [0]}]"
)


class Last:
    """Keeps what was observed last of the links while the mission was on."""

    def __init__(self) -> None:
        self.links: tuple[tuple[int, int], ...] = ()

    def observe(self, observation: Observation) -> None:
        if observation.mission_tick is not None:
            self.links = observation.links


def flown(mission: Mission) -> tuple[dict[str, Any], tuple[tuple[int, int], ...]]:
    metrics, last = Metrics(costs=Costs(mission.faults, tick_s=mission.tick_s)), Last()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.run(pace=Lockstep(), observers=[metrics, last], stop=lambda: False)
    report = make_report(flight.side, metrics, wall_s=1.0, recording=None)
    return {key: value for key, value in report.items() if key != "timing"}, last.links


def mission(*changes: str) -> Mission:
    small = ("agents.count=4", "targets.count=5", "vehicle.boot_s=0.5", "duration_s=20", "radio.range_m=40000")
    return load_mission("quickstart", overrides=[Override(text) for text in (*small, *changes)])


def test_in_the_field_agents_decide_as_under_an_air_without_an_end() -> None:
    (field, links), (air, _) = flown(mission("radio.mode=field")), flown(mission("radio.mode=ideal"))
    assert field == air
    assert field["radio"]["delivered"] == 3 * field["radio"]["sent"] > 0
    assert links == ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))


def test_so_they_do_when_computers_fail_and_who_is_off_is_heard_by_nobody_and_hears_nothing() -> None:
    (field, links), (air, _) = flown(mission("radio.mode=field", FAULTS)), flown(mission("radio.mode=ideal", FAULTS))
    assert {key: value for key, value in field.items() if key != "radio"} == {
        key: value for key, value in air.items() if key != "radio"
    }
    counted, told = field["radio"], air["radio"]
    assert {key: counted[key] for key in ("sent", "bytes", "refused")} == {
        key: told[key] for key in ("sent", "bytes", "refused")
    }
    # Under an air a dead computer's receiver still counts as reached; in the field nobody knows that it was.
    assert counted["delivered"] + counted["out_of_range"] + counted["refused"] == 3 * counted["sent"]
    assert 0 < counted["out_of_range"] < told["delivered"]
    assert links == ((1, 2), (1, 3), (2, 3))


def test_the_guides_mission_can_be_flown() -> None:
    page = (Path(__file__).parents[2] / "docs" / "field.md").read_text(encoding="utf-8")
    text = page.partition("```yaml\n")[2].partition("```")[0]
    mission = parse_mission(text.encode(), source="docs/field.md", folder=Path())
    assert mission.radio.mode == "field"
    assert len(mission.radio.endpoints) == mission.agents.count


def test_the_guides_detector_is_understood() -> None:
    page = (Path(__file__).parents[2] / "docs" / "field.md").read_text(encoding="utf-8")
    [line] = [line for line in page.splitlines() if line.strip().startswith("targets = [")]
    targets = ast.literal_eval(line.partition("=")[2].strip())
    sight = decode_sight(json.dumps({"at_s": 1.0, "targets": targets}).encode(), n_targets=4)
    assert sight is not None
    assert sight.targets[0].target == 3


def test_a_study_does_not_know_the_field() -> None:
    with pytest.raises(MissionError, match='got "field"; allowed: sim or ideal'):
        load_mission("quickstart", overrides=[Override("radio.mode=field")], for_study=True)
