"""Laws of the mission loader: what round-trips, what overrides do, and that no input breaks it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from ruamel.yaml import YAML

from comms.arena import disc, rectangle
from missions.load import LIBRARY, bundled_names, dump_mission, load_mission, parse_mission
from missions.mission import Mission, MovingTargets, TrackTargets
from missions.overrides import Override
from missions.problems import MissionError

ANY_TRACKS = LIBRARY / "tracks.csv"
REFERENCE = (LIBRARY / "reference.yaml").read_text(encoding="utf-8")


def load_bundled(name: str, *more: Override) -> Mission:
    """A bundled mission; the one whose data does not come with the package is lent other tracks."""
    lent = [Override(f"targets.file={ANY_TRACKS}")] if name == "baboons" else []
    return load_mission(name, overrides=[*lent, *more])


def parsed(text: str, *overrides: str) -> Mission:
    return parse_mission(
        text.encode(), source="m.yaml", folder=LIBRARY, overrides=[Override(override) for override in overrides]
    )


def problems(text: str, *overrides: str) -> list[str]:
    with pytest.raises(MissionError) as caught:
        parsed(text, *overrides)
    return str(caught.value).splitlines()


def leaves(section: dict[str, Any], prefix: str = "") -> list[tuple[str, Any]]:
    """Every value with its dotted key."""
    found: list[tuple[str, Any]] = []
    for key, value in section.items():
        found += leaves(value, f"{prefix}{key}.") if isinstance(value, dict) else [(f"{prefix}{key}", value)]
    return found


@pytest.mark.parametrize("name", bundled_names())
def test_a_bundled_mission_round_trips(name: str, tmp_path: Path) -> None:
    mission = load_bundled(name)
    assert mission.name == name
    copy = tmp_path / "copy.yaml"
    copy.write_text(dump_mission(mission), encoding="utf-8")
    assert load_mission(str(copy)) == mission


@pytest.mark.parametrize("name", bundled_names())
def test_overriding_a_value_with_itself_changes_nothing(name: str) -> None:
    mission = load_bundled(name)
    own = leaves(mission.model_dump(mode="json"))
    assert len(own) > 40
    assert load_bundled(name, *(Override(f"{key}={json.dumps(value)}") for key, value in own)) == mission


def test_a_mission_cannot_be_changed() -> None:
    mission = load_mission("quickstart")
    with pytest.raises(ValidationError, match="frozen"):
        mission.agents.count = 3


def test_a_whole_number_will_do_for_a_float() -> None:
    radius_m = parsed("name: m\nagents: {deployment: {radius_m: 15}}\n").agents.deployment.radius_m
    assert radius_m == 15.0
    assert type(radius_m) is float


def test_a_section_that_names_no_kind_is_of_the_default_kind() -> None:
    mission = parsed("name: m\narena: {radius_m: 40}\ntargets: {count: 3}\n")
    assert mission.arena.area == disc(40.0)
    assert isinstance(mission.targets, MovingTargets)
    assert (mission.targets.motion, mission.targets.count) == ("evasive", 3)


def test_a_rectangle_is_the_worlds_rectangle() -> None:
    assert parsed("name: m\narena: {shape: rectangle, width_m: 40}\n").arena.area == rectangle(40.0, 60.0)


def test_targets_notice_cameras_as_far_as_the_highest_sees() -> None:
    text = "name: m\nagents: {count: 3, sensing: {field_of_view: camera, half_angle_deg: 45}}\n"
    assert parsed(text).target_sensing_range_m == pytest.approx(14.0)


@pytest.mark.parametrize(("given_m", "expected_m"), [("null", 7.0), ("3", 3.0)])
def test_targets_notice_as_far_as_agents_see_unless_told(given_m: str, expected_m: float) -> None:
    text = f"name: m\nagents: {{sensing: {{range_m: 7}}}}\ntargets: {{sensing_range_m: {given_m}}}\n"
    assert parsed(text).target_sensing_range_m == expected_m


def test_layers_are_shared_once_they_are_all_taken() -> None:
    altitude = parsed("name: m\nagents: {altitude: {base_m: 10, layer_m: 2, layers: 3}}\n").agents.altitude
    assert [altitude.of_agent(uid) for uid in range(5)] == [10.0, 12.0, 14.0, 10.0, 12.0]


def test_a_relative_file_starts_at_the_mission_file(tmp_path: Path) -> None:
    (tmp_path / "deer.csv").write_text("t,id,x,y\n")
    mission = tmp_path / "m.yaml"
    mission.write_text("name: m\ntargets: {motion: tracks, file: deer.csv}\n")
    targets = load_mission(str(mission)).targets
    assert isinstance(targets, TrackTargets)
    assert targets.file == tmp_path / "deer.csv"


def test_a_relative_file_of_an_override_starts_at_the_working_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "deer.csv").write_text("t,id,x,y\n")
    monkeypatch.chdir(tmp_path)
    targets = load_mission("baboons", overrides=[Override("targets.file=deer.csv")]).targets
    assert isinstance(targets, TrackTargets)
    assert targets.file == tmp_path / "deer.csv"


# Overrides.


def test_a_later_override_wins() -> None:
    assert parsed("name: m\nseed: 1\n", "seed=2", "seed=3").seed == 3


def test_an_override_makes_the_sections_it_needs() -> None:
    assert parsed("name: m\n", "vehicle.wind.gust_m_s=2").vehicle.wind.gust_m_s == 2.0


def test_an_override_may_replace_a_whole_section() -> None:
    mission = parsed(
        "name: m\ntargets: {motion: random, count: 3}\n", f"targets={{motion: tracks, file: {ANY_TRACKS}}}"
    )
    assert isinstance(mission.targets, TrackTargets)


def test_an_override_mends_a_wrong_value() -> None:
    assert parsed("name: m\nseed: -1\n", "seed=5").seed == 5


@pytest.mark.parametrize(
    ("override", "expected"),
    [
        ("agents.count=0", "--set: agents.count: got 0; allowed: a whole number from 1 to 1000"),
        ("agents.cuont=3", "--set: agents.cuont: got an unknown key; "
         "allowed: count, speed_m_s, sensing, deployment, altitude, may_lose, world_timeout_s; did you mean count?"),
        ("agents={count: 3, sped_m_s: 1}", "--set: agents.sped_m_s: got an unknown key; "
         "allowed: count, speed_m_s, sensing, deployment, altitude, may_lose, world_timeout_s; "
         "did you mean speed_m_s?"),
        ("agents.count.max=3", "--set: agents.count: got a mapping; allowed: a whole number from 1 to 1000"),
        ("seed=", "--set: seed: got null; allowed: a whole number from 0 to 4294967295"),
        ("seed='7'", '--set: seed: got "7"; allowed: a whole number from 0 to 4294967295'),
        ("seed='", "--set: seed: got bad YAML (found unexpected end of stream); allowed: YAML 1.2"),
        ("seed={a: 1, a: 2}", "--set: seed.a: got a second value; allowed: each key once\n"
         "--set: seed: got a mapping; allowed: a whole number from 0 to 4294967295"),
        ("seed", '--set: got "seed"; allowed: KEY=VALUE, such as agents.count=5'),
        ("=5", '--set: got "=5"; allowed: KEY=VALUE, such as agents.count=5'),
        ("agents..count=5", '--set: got "agents..count=5"; allowed: KEY=VALUE, such as agents.count=5'),
        ("agents.sensing.range_m=21", "--set: radio.range_m: got 20 (the default); "
         "allowed: more than agents.sensing.range_m (21)"),
    ],
)  # fmt: skip
def test_a_wrong_override_is_named_as_one(override: str, expected: str) -> None:
    assert problems("name: m\n", override) == expected.splitlines()


def test_mistakes_of_the_file_come_before_those_of_overrides() -> None:
    assert problems("name: m\nseed: -1\ntick_s: 9\n", "agents.count=0") == [
        "m.yaml:2: seed: got -1; allowed: a whole number from 0 to 4294967295",
        "m.yaml:3: tick_s: got 9; allowed: a number from 0.01 to 1",
        "--set: agents.count: got 0; allowed: a whole number from 1 to 1000",
    ]


# Whatever the input: a mission, or mistakes of one line each.


def accepts_or_explains(data: bytes, *overrides: str) -> None:
    try:
        mission = parse_mission(
            data, source="m.yaml", folder=LIBRARY, overrides=[Override(override) for override in overrides]
        )
    except MissionError as error:
        lines = [str(problem) for problem in error.problems]
        assert lines
        assert all(line.startswith(("m.yaml", "--set")) for line in lines)
        assert all("; allowed: " in line and len(line.splitlines()) == 1 for line in lines)
    else:
        assert isinstance(mission, Mission)


@given(st.binary(max_size=60))
def test_any_bytes_are_accepted_or_explained(data: bytes) -> None:
    accepts_or_explains(data)


SCALARS = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8), st.lists(st.integers(), max_size=2)
)
KEYS = st.sampled_from([key for key, _ in leaves(YAML(typ="safe", pure=True).load(REFERENCE))])


@given(st.lists(st.tuples(KEYS, SCALARS), min_size=1, max_size=6), st.text(max_size=12))
def test_any_values_are_accepted_or_explained(values: list[tuple[str, Any]], text: str) -> None:
    accepts_or_explains(b"name: m\n", *(f"{key}={json.dumps(value)}" for key, value in values), text)


@given(st.integers(0, len(REFERENCE) - 1), st.text(alphabet=" :{}[]#&*!|>'\"%@`-\n\t0a", min_size=1, max_size=3))
def test_a_slip_of_the_finger_is_accepted_or_explained(place: int, slip: str) -> None:
    accepts_or_explains((REFERENCE[:place] + slip + REFERENCE[place + 1 :]).encode())


@pytest.mark.parametrize(
    ("sensing", "policy", "standoff_m"),
    [
        ("{}", "{}", 0.0),
        ("{field_of_view: camera}", "{}", 0.0),
        ("{field_of_view: sector, range_m: 6}", "{}", 2.0),
        ("{field_of_view: sector, opening_deg: 360}", "{}", 0.0),
        ("{field_of_view: sector}", "{standoff_m: 0}", 0.0),
        ("{}", "{standoff_m: 1.5}", 1.5),
    ],
)
def test_who_looks_ahead_flies_behind_a_target(sensing: str, policy: str, standoff_m: float) -> None:
    overrides = [Override(f"agents.sensing={sensing}"), Override(f"policy={policy}")]
    assert load_mission("quickstart", overrides=overrides).standoff_m == standoff_m
