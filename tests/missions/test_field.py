"""Missions whose agents hear each other directly: the same decisions as by an ideal air without an end."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import pytest

from comms.clock import Lockstep
from comms.codec import encode
from comms.keys import Keys
from comms.messages import Frame
from comms.session import Bus, open_local_bus
from comms.sight import decode_sight
from comms.status import Level
from missions import compose
from missions.faults.costs import Costs
from missions.flight import Flight
from missions.load import load_mission, parse_mission
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observation
from missions.overrides import Override
from missions.problems import MissionError
from missions.report import make_report
from missions.sides.agent import AgentSide, agent_sides
from missions.sides.computer import HEARS_MORE
from missions.sides.exchange import Cue

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


def side(mission: Mission, bus: Bus) -> AgentSide:
    [side] = agent_sides(mission, compose.radios(mission, bus, [0], n_targets=5), n_targets=5)
    return side


def say(mission: Mission, bus: Bus, src: int, tick: int) -> None:
    said = Frame(src, tick, tick * mission.tick_s, 0.5, (0.0, 0.0, 10.0), (0.0, 0.0, 0.0))
    bus.publisher(Keys(mission.name).tx(src))(encode(said))


def test_who_hears_more_than_the_world_has_counted_believes_it_and_says_so_once() -> None:
    field, told = mission("radio.mode=field"), []
    with open_local_bus() as bus:
        agent = side(field, bus)
        for tick in range(4):
            done = agent.tick(Cue(tick=tick, frames=1 if tick else 0, life=7))
            told += [(tick, event.level) for event in done.status.events if event.text == HEARS_MORE]
            say(field, bus, 1, tick)
            if tick:
                say(field, bus, 2, tick)  # and dies before its done
        assert (done.radio.heard, done.radio.refused) == (5, 0)
    assert told == [(2, Level.WARNING)]


def test_in_the_field_fewer_frames_than_were_sent_are_loud() -> None:
    field = mission("radio.mode=field")
    with open_local_bus() as bus:
        agent = side(field, bus)
        say(field, bus, 1, 0)
        bus.publisher(Keys(field.name).tx(1))(b"rubbish")  # in nobody's stead
        with pytest.raises(RuntimeError, match=r"lockstep broken at 0.1 s, agent 0: "):
            agent.tick(Cue(tick=1, frames=2, life=7))


@pytest.mark.parametrize("twice", [True, False], ids=["of one mate", "of another one"])
def test_in_one_process_more_frames_than_were_sent_are_loud(twice: bool) -> None:
    field = mission("radio.mode=field")
    with open_local_bus() as bus:
        agent = side(field, bus)
        for src in (1, 1 if twice else 2):
            say(field, bus, src, 0)
        with pytest.raises(RuntimeError, match=r"lockstep broken at 0.1 s, agent 0: 2 frames arrived of 1"):
            agent.tick(Cue(tick=1, frames=1))


def test_under_an_air_more_frames_than_were_sent_are_loud() -> None:
    simulated = mission("radio.mode=sim")
    with open_local_bus() as bus:
        agent = side(simulated, bus)
        bus.publisher(Keys(simulated.name).rx(0))(b"rubbish")
        with pytest.raises(RuntimeError, match=r"lockstep broken at 0.1 s, agent 0: 1 frames arrived of 0"):
            agent.tick(Cue(tick=1, life=7))


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
