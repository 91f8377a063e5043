"""What a study file comes to: its points, in order, and that written out it comes to the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from missions.load import load_mission
from missions.mission import Mission, MovingTargets
from missions.overrides import Override
from missions.problems import InputError
from missions.study.load import bundled_studies, dump_study, load_study
from missions.study.points import matches, varied
from missions.study.words import axis_words, point_words, telling_keys, value_words
from tests.missions.study.toy_runs import STUDY


@pytest.fixture
def study(tmp_path: Path) -> str:
    path = tmp_path / "toy.yaml"
    path.write_text(STUDY, encoding="utf-8")
    return str(path)


def facts(mission: Mission) -> tuple[int, float, int, str]:
    assert isinstance(mission.targets, MovingTargets)
    return mission.agents.count, mission.agents.deployment.radius_m, mission.targets.count, mission.policy.name


def test_axes_are_crossed_and_keys_of_one_axis_go_in_step(study: str) -> None:
    points = load_study(study).points
    assert [facts(point.mission) for point in points] == [
        (5, 10.0, 10, "b-cmommt-basic"),
        (5, 10.0, 10, "b-cmommt"),
        (5, 10.0, 20, "b-cmommt-basic"),
        (5, 10.0, 20, "b-cmommt"),
        (10, 15.0, 10, "b-cmommt-basic"),
        (10, 15.0, 10, "b-cmommt"),
        (10, 15.0, 20, "b-cmommt-basic"),
        (10, 15.0, 20, "b-cmommt"),
    ]
    assert [point.number for point in points] == list(range(8))
    assert dict(points[5].labels) == {
        "agents.count": 10, "agents.deployment.radius_m": 15, "targets.count": 10, "policy": "default",
    }  # fmt: skip
    assert len({point.digest for point in points}) == 8
    assert all(point.mission.duration_s == 20.0 for point in points)


def test_a_study_without_a_sweep_is_one_point(tmp_path: Path) -> None:
    (tmp_path / "one.yaml").write_text("name: one\nmission: narrow\n")
    ready = load_study(str(tmp_path / "one.yaml"))
    assert [point.mission for point in ready.points] == [load_mission("narrow")]
    assert ready.points[0].labels == (("policy", "b-cmommt"),)
    assert ready.seeds == range(1, 101)


def test_a_mission_is_found_beside_the_study(tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_text("name: mine\nagents: {count: 3}\n")
    (tmp_path / "s.yaml").write_text("name: s\nmission: m.yaml\nsweep: [{targets.count: [4]}]\n")
    (point,) = load_study(str(tmp_path / "s.yaml")).points
    assert facts(point.mission)[::2] == (3, 4)


@pytest.mark.parametrize("name", bundled_studies())
def test_a_bundled_study_written_out_comes_to_the_same_points(name: str, tmp_path: Path) -> None:
    ready = load_study(name)
    assert ready.study.name == name
    copy = tmp_path / "copy.yaml"
    copy.write_text(dump_study(ready), encoding="utf-8")
    again = load_study(str(copy))
    assert again.points == ready.points
    assert (again.seeds, again.study.figures, again.study.claims) == (
        ready.seeds, ready.study.figures, ready.study.claims,
    )  # fmt: skip


def test_names_and_seeds_are_no_part_of_a_digest(study: str) -> None:
    digests = [point.digest for point in load_study(study).points]
    renamed = load_study(study, overrides=[Override("name=other"), Override("seed=77")])
    assert [point.digest for point in renamed.points] == digests
    assert [point.digest for point in load_study(study, overrides=[Override("tick_s=0.2")]).points] != digests


def test_the_command_line_changes_runs_seed_and_policies(study: str) -> None:
    ready = load_study(study, runs=2, seed=9, policies=["regions", "basic"])
    assert ready.seeds == range(9, 11)
    assert [facts(point.mission)[3] for point in ready.points[:2]] == ["regions", "b-cmommt-basic"]
    assert [dict(point.labels)["policy"] for point in ready.points[:2]] == ["regions", "basic"]


def test_an_unknown_policy_lists_the_known_ones(study: str) -> None:
    with pytest.raises(InputError) as caught:
        load_study(study, policies=["shepard"])
    assert str(caught.value) == (
        '--policy: got "shepard"; allowed: basic, default, a-cmommt, b-cmommt-basic, b-cmommt or regions'
    )


def test_points_are_picked_by_what_varies_and_what_follows_from_it(study: str) -> None:
    points = load_study(study).points
    assert [p.number for p in points if matches(p, {"policy": "basic", "agents.count": 10})] == [4, 6]
    assert [p.number for p in points if matches(p, {"ratio": 2, "policy": ["basic", "default"]})] == [0, 1, 6, 7]
    assert [p.number for p in points if matches(p, {"agents": 7})] == []


def test_points_are_told_apart_by_what_varies_alone(study: str) -> None:
    points = load_study(study).points
    assert varied(points) == ["agents.count", "agents.deployment.radius_m", "targets.count", "policy"]
    assert varied(points[:2]) == ["policy"]
    assert telling_keys(points, but="targets.count") == ["agents.count", "agents.deployment.radius_m", "policy"]
    # What goes in step with the axis does not tell lines apart.
    assert telling_keys(points, but="agents.count") == ["targets.count", "policy"]
    assert point_words(points[0], varied(points)) == "5 agents, radius 10 m, 10 targets, basic"


@pytest.mark.parametrize(
    ("key", "value", "axis", "words"),
    [
        ("agents.count", 1, "agents", "1 agent"),
        ("targets.speed_m_s", 0.3, "speed (m/s)", "speed 0.3 m/s"),
        ("policy.help_margin_s", 40, "help margin (s)", "help margin 40 s"),
        ("policy.explore", "stale-first", "explore", "explore stale-first"),
        ("vehicle.limits.acceleration_m_s2", 2, "acceleration (m/s²)", "acceleration 2 m/s²"),
    ],
)
def test_keys_become_words(key: str, value: object, axis: str, words: str) -> None:
    assert (axis_words(key), value_words(key, value)) == (axis, words)
