"""The plan of a mission: hand-computed numbers, and the printed page as a whole."""

from __future__ import annotations

from math import isclose, pi
from pathlib import Path

import pytest

from comms.frames import enu_from_geo
from missions.cli import main
from missions.exit_codes import DONE
from missions.load import load_mission
from missions.mission import AgentDeployment, Agents, Altitude, Disc, Mission, Sensing
from missions.observation import Phase
from missions.overrides import Override
from missions.plan import coverage_floor, plan_mission

# To renew it: swarm plan quickstart > tests/missions/plan_quickstart.txt
GOLDEN = Path(__file__).parent / "plan_quickstart.txt"


def test_floor_of_the_papers_world() -> None:
    # 10 discs of 5.5 m on one of 30 m: 1 - (1 - 30.25 / 900) ** 10; the paper's "29 %".
    assert isclose(coverage_floor(load_mission("quickstart")), 0.28957, abs_tol=1e-5)


def test_floor_of_one_agent_is_its_share_of_the_arena() -> None:
    mission = load_mission("baboons", overrides=[Override(f"targets.file={__file__}"), Override("agents.count=1")])
    assert isclose(coverage_floor(mission), pi * 15**2 / (140 * 200))


def test_floor_of_a_sector_is_smaller_by_its_share_of_the_circle() -> None:
    sensing = Sensing(range_m=6, field_of_view="sector", opening_deg=90)
    assert isclose(coverage_floor(Mission(name="m", agents=Agents(count=1, sensing=sensing))), 0.25 * 36 / 900)


def test_floor_of_cameras_counts_each_at_its_height() -> None:
    agents = Agents(count=2, sensing=Sensing(field_of_view="camera", half_angle_deg=45))  # 10 m and 12 m high
    assert agents.sensing_ranges_m == pytest.approx((10, 12))
    assert isclose(coverage_floor(Mission(name="m", agents=agents)), 1 - (1 - 100 / 900) * (1 - 144 / 900))


def test_an_agent_that_sees_all_has_floor_one() -> None:
    mission = Mission(name="m", arena=Disc(radius_m=16), agents=Agents(count=1, sensing=Sensing(range_m=17)))
    assert coverage_floor(mission) == 1.0


def test_agents_start_on_their_layers_apart_within_the_deployment() -> None:
    deployment = AgentDeployment(radius_m=10, spacing_m=2)
    altitude = Altitude(base_m=20, layer_m=3, layers=4)
    mission = Mission(name="m", agents=Agents(count=6, deployment=deployment, altitude=altitude))
    agents = plan_mission(mission).agents
    assert [agent.uid for agent in agents] == [0, 1, 2, 3, 4, 5]
    assert [agent.system_id for agent in agents] == [1, 2, 3, 4, 5, 6]
    assert [agent.start_m[2] for agent in agents] == [20.0, 23.0, 26.0, 29.0, 20.0, 23.0]
    places = [complex(*agent.start_m[:2]) for agent in agents]
    assert all(abs(place) <= 10 for place in places)
    assert all(abs(a - b) >= 2 for i, a in enumerate(places) for b in places[:i])
    for agent, place in zip(agents, places, strict=True):
        east, north, up = enu_from_geo(mission.home.place, agent.home)
        assert abs(complex(east, north) - place) < 1e-6
        assert up == 0.0


def test_phases_in_order() -> None:
    # Ten agents reach 28 m: 2 s to boot and 28 / 2.5 s to climb; 28 / 1.5 s down.
    phases = plan_mission(load_mission("quickstart")).phases
    assert [phase.phase for phase in phases] == [Phase.PREPARE, Phase.MISSION, Phase.RETURN]
    assert [round(phase.duration_s, 3) for phase in phases] == [13.2, 240.0, 18.667]


def test_printed_away_from_a_terminal_it_is_plain_and_always_the_same(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "20")
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert main(["plan", "quickstart"]) == DONE
    assert capsys.readouterr().out == GOLDEN.read_text(encoding="utf-8")


def test_a_description_is_printed_as_written(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "quickstart", "--set", "description='[/red] :smile:'"]) == DONE
    assert "[/red] :smile:" in capsys.readouterr().out.splitlines()
