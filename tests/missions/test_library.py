"""The bundled missions: each loads, fits the schema and plans; the reference is the manual; the tracks are as told."""

from __future__ import annotations

import csv
import re
from math import pi, sin
from typing import Any

import jsonschema
import pytest
from ruamel.yaml import YAML

from comms.chance import draw
from missions.keys import every_key
from missions.load import LIBRARY, bundled_names, load_mission, parse_mission
from missions.mission import Mission, TrackTargets
from missions.problems import dotted
from missions.schema import mission_schema

REFERENCE = (LIBRARY / "reference.yaml").read_text(encoding="utf-8")


def written(name: str) -> Any:
    """A bundled file as plain values, read as any YAML 1.2 reader would."""
    return YAML(typ="safe", pure=True).load((LIBRARY / f"{name}.yaml").read_text(encoding="utf-8"))


def errors_of(values: Any) -> list[str]:
    validator = jsonschema.Draft202012Validator(mission_schema())
    return [error.message for error in validator.iter_errors(values)]


def test_these_are_bundled() -> None:
    assert bundled_names() == [
        "baboons",
        "crowded",
        "faults",
        "narrow",
        "quickstart",
        "reference",
        "tracks",
        "wildlife",
    ]


# The schema.


def test_the_schema_is_one() -> None:
    jsonschema.Draft202012Validator.check_schema(mission_schema())


@pytest.mark.parametrize("name", sorted({*bundled_names()} - {"baboons"}))
def test_bundled_missions_fit_the_schema(name: str) -> None:
    assert errors_of(written(name)) == []


def test_a_mission_that_needs_a_file_fits_the_schema_once_it_has_one() -> None:
    values = written("baboons")
    assert errors_of(values) != []
    values["targets"]["file"] = "baboons.csv"
    assert errors_of(values) == []


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"name": "a b"},
        {"name": "m", "sed": 1},
        {"name": "m", "seed": "1"},
        {"name": "m", "agents": {"count": 1001}},
        {"name": "m", "arena": {"shape": "polygon"}},
        {"name": "m", "arena": {"width_m": 3, "radius_m": 3}},
        {"name": "m", "targets": {"motion": "tracks"}},
    ],
)
def test_the_schema_refuses(values: Any) -> None:
    assert errors_of(values) != []


def test_every_key_has_a_description_in_the_schema() -> None:
    schema = mission_schema()
    sections = [schema, *schema["$defs"].values()]
    keys = [(name, key) for section in sections for name, key in section["properties"].items()]
    assert len(keys) > 50
    # A section described in the words of its kind has them there.
    assert [name for name, key in keys if not key.get("description") and "$ref" not in key] == []
    assert [name for name, section in schema["$defs"].items() if not section.get("description")] == []


# The reference.


def listed(text: str) -> dict[str, str]:
    """Dotted key -> the value as written, of every key in the text, commented out or not."""
    found: dict[str, str] = {}
    path: list[str] = []
    for line in text.splitlines():
        match = re.match(
            r"^(?P<indent>(?:  )*)(?:# )?(?P<key>[a-z_0-9]+):(?: +(?P<value>[^#]*[^# ]))?(?: *#.*)?$", line
        )
        if match is not None:
            path = [*path[: len(match["indent"]) // 2], match["key"]]
            found.setdefault(".".join(path), match["value"] or "")
    return found


def test_the_reference_lists_every_key_and_no_other() -> None:
    assert set(listed(REFERENCE)) == {dotted(key.path) for key in every_key()}


def test_the_reference_says_something_of_every_value() -> None:
    silent = [line for line in REFERENCE.splitlines() if re.match(r"^ *(# )?[a-z_0-9]+: +[^ #]+ *$", line)]
    assert silent == []


def test_the_reference_gives_the_defaults() -> None:
    assert load_mission("reference") == Mission(name="reference")
    assert set(leaf_keys(written("reference"))) == set(leaf_keys(Mission(name="x").model_dump(mode="json")))


def leaf_keys(section: dict[str, Any], prefix: str = "") -> list[str]:
    nested = [leaf_keys(v, f"{prefix}{k}.") if isinstance(v, dict) else [f"{prefix}{k}"] for k, v in section.items()]
    return [key for keys in nested for key in keys]


@pytest.mark.parametrize(("section", "kind"), [("arena", "shape: rectangle"), ("targets", "motion: tracks")])
def test_the_commented_out_kinds_give_their_defaults(section: str, kind: str) -> None:
    block = re.search(rf"^{section}:.*?(?=^\S)", REFERENCE, re.MULTILINE | re.DOTALL)
    assert block is not None
    other = re.findall(r"^  # ([a-z_]+: .*)$", block[0], re.MULTILINE)
    assert other[0].startswith(kind)

    def loaded(lines: list[str]) -> Mission:
        text = "\n  ".join([f"name: m\n{section}:", *lines])
        return parse_mission(text.encode(), source="m.yaml", folder=LIBRARY)

    needed = [line for line in other if line.startswith((kind, "file:"))]
    assert len(other) > len(needed)
    assert loaded(other) == loaded(needed)


# The tracks.

PRESENT = {5: (0, 150), 6: (0, 180), 7: (60, 240), 8: (100, 240), 9: (45, 200)}


def test_the_tracks_are_what_their_formula_says() -> None:
    def place(animal: int, t: int, axis: int) -> float:
        u = [draw(7, k, animal, 0) for k in range(8)]
        p, q = 200 + 120 * u[axis + 4], 70 + 40 * u[axis + 6]
        return 18 * sin(2 * pi * (t / p + u[axis])) + 8 * sin(2 * pi * (t / q + u[axis + 2]))

    expected = [
        [str(t), f"animal-{animal}", f"{place(animal, t, 0):.2f}", f"{place(animal, t, 1):.2f}"]
        for t in range(241)
        for animal in range(10)
        if PRESENT.get(animal, (0, 240))[0] <= t <= PRESENT.get(animal, (0, 240))[1]
    ]
    with (LIBRARY / "tracks.csv").open(newline="") as file:
        assert list(csv.reader(file)) == [["t", "id", "x", "y"], *expected]


def test_the_tracks_stay_in_their_arena_and_below_the_agents_speed() -> None:
    mission = load_mission("tracks")
    assert isinstance(mission.targets, TrackTargets)
    with mission.targets.file.open(newline="") as file:
        rows = [(float(r["t"]), r["id"], float(r["x"]), float(r["y"])) for r in csv.DictReader(file)]
    assert max((x * x + y * y) ** 0.5 for _, _, x, y in rows) < mission.arena.area.half_x_m
    last: dict[str, tuple[float, float]] = {}
    for _, animal, x, y in rows:
        was_x, was_y = last.get(animal, (x, y))
        assert ((x - was_x) ** 2 + (y - was_y) ** 2) ** 0.5 < mission.agents.speed_m_s
        last[animal] = (x, y)
