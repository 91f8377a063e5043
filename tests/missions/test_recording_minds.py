"""What a recording tells of minds, of MAVLink and of sight, held against the flight that it is of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import acos, cos, hypot, isclose, pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
import rerun as rr
from rerun.chunk import RrdReader

from comms.chance import draw
from comms.clock import Lockstep
from comms.knowledge import Belief, Knowledge, Mate
from comms.session import open_local_bus
from comms.status import Activity, AgentStatus
from missions.flight import Flight
from missions.launch import explain_every_s, recorder_of
from missions.load import load_mission
from missions.observation import Observation
from missions.options import LaunchOptions
from missions.overrides import Override
from missions.recording.block import Block
from missions.recording.minds import page
from missions.recording.sight import Sight
from tests.missions.toy_observations import PREPARATION, toy_observations, toy_scene
from vehicle_sim.sensing import sees

N_AGENTS = 4


@dataclass
class Kept:
    """An observer that keeps what it is told."""

    observations: list[Observation] = field(default_factory=list)

    def observe(self, observation: Observation) -> None:
        self.observations.append(observation)


def _fly(path: Path | None) -> list[Observation]:
    changes = ("agents.count=4", "targets.count=4", "duration_s=15", "radio.loss=0.2")
    mission = load_mission("narrow", overrides=[Override(text) for text in changes])
    kept = Kept()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        if path is None:
            flight.run(pace=Lockstep(), observers=[kept], stop=lambda: False)
            return kept.observations
        flight.side.explain_every_s = explain_every_s(mission)
        with recorder_of(mission, len(flight.world.places), LaunchOptions(record=path)) as recorder:
            flight.run(pace=Lockstep(), observers=[kept, recorder], stop=lambda: False)
    return kept.observations


@pytest.fixture(scope="module", autouse=True)
def _strict() -> Iterator[None]:
    before = rr.strict_mode()
    rr.set_strict_mode(True)
    yield
    rr.set_strict_mode(before)


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Observation]]:
    path = tmp_path_factory.mktemp("minds") / "flown.rrd"
    return path, _fly(path)


def _rows(path: Path, entity: str, component: str) -> dict[int, list[Any]]:
    """Tick -> what was recorded then."""
    found = {}
    for chunk in RrdReader(path).stream().filter(content=entity, components=component, is_static=False).to_chunks():
        batch = pa.record_batch(chunk.to_record_batch())
        values = zip(batch.column("tick").to_pylist(), batch.column(component).to_pylist(), strict=True)
        found |= {tick: value for tick, value in values if value is not None}
    return dict(sorted(found.items()))


def test_every_agent_tells_once_a_second_and_only_when_somebody_records(
    flown: tuple[Path, list[Observation]],
) -> None:
    _, observations = flown
    for seen in observations:
        told = [status.knowledge is not None for status in seen.statuses]
        assert told == [seen.tick % 10 == 0] * N_AGENTS
    assert all(status.knowledge is None for seen in _fly(None) for status in seen.statuses)


def test_to_be_asked_changes_nothing(flown: tuple[Path, list[Observation]]) -> None:
    silent = _fly(None)
    assert [seen.truths for seen in silent] == [seen.truths for seen in flown[1]]
    assert [seen.totals for seen in silent] == [seen.totals for seen in flown[1]]


@pytest.mark.parametrize("uid", range(N_AGENTS))
def test_a_mind_is_recorded_as_it_was_told(flown: tuple[Path, list[Observation]], uid: int) -> None:
    path, observations = flown
    points = _rows(path, f"/knowledge/A{uid}", "Points3D:positions")
    labels = _rows(path, f"/knowledge/A{uid}", "Points3D:labels")
    pages = _rows(path, f"/knowledge/A{uid}", "TextDocument:text")
    told = [seen for seen in observations if seen.statuses[uid].knowledge is not None]
    assert list(points) == list(pages) == [seen.tick for seen in told]
    for seen in told:
        known = seen.statuses[uid].knowledge
        assert known is not None
        places = [belief.place_m for belief in known.beliefs] + [mate.place_m for mate in known.mates]
        assert np.array(points[seen.tick])[1:, :2] == pytest.approx(np.array(places).reshape(-1, 2), abs=1 / 128 + 1e-6)
        names = [f"A{uid}", *(f"T{b.target}" for b in known.beliefs), *(f"A{m.uid}" for m in known.mates)]
        assert [label.split(",")[0] for label in labels[seen.tick]] == names
        assert known.why in pages[seen.tick][0]
    assert any(len(batch) > 2 for batch in points.values())


def test_own_targets_are_believed_where_they_are(flown: tuple[Path, list[Observation]]) -> None:
    held = [
        (belief, seen.targets[belief.target])
        for seen in flown[1]
        for status in seen.statuses
        if status.knowledge is not None
        for belief in status.knowledge.beliefs
        if belief.sensed
    ]
    assert held
    assert all(belief.place_m == (truth.x_m, truth.y_m) for belief, truth in held)


def test_messages_are_the_autopilots_own(flown: tuple[Path, list[Observation]]) -> None:
    path, _ = flown
    names, *_ = _rows(path, "/mavlink/A2/GLOBAL_POSITION_INT", "SeriesLines:names").values()
    rows = _rows(path, "/mavlink/A2/GLOBAL_POSITION_INT", "Scalars:scalars")
    assert rows
    home = load_mission("narrow").home.place
    for numbers in rows.values():
        message = dict(zip(names, numbers, strict=True))
        assert message["lat"] / 1e7 == pytest.approx(home.latitude_deg, abs=1e-3)
        assert message["lon"] / 1e7 == pytest.approx(home.longitude_deg, abs=1e-3)
    tick, (text,) = max(_rows(path, "/mavlink/A2", "TextDocument:text").items())
    last = dict(zip(names, rows[tick], strict=True))
    (line,) = (line for line in text.splitlines() if line.startswith("| GLOBAL_POSITION_INT |"))
    assert f", lat {last['lat']:.0f}, lon {last['lon']:.0f}, " in line


def test_the_truth_is_told_beside_what_was_believed(flown: tuple[Path, list[Observation]]) -> None:
    path, observations = flown
    told = [seen for seen in observations if any(status.knowledge for status in seen.statuses)]
    agents, targets = (_rows(path, f"/truth/{who}", "Points3D:positions") for who in ("agents", "targets"))
    assert [*agents] == [*targets] == [seen.tick for seen in told]
    for seen in told:
        places = [list(truth.position_m) for truth in seen.truths]
        assert np.array(agents[seen.tick]) == pytest.approx(np.array(places), abs=1 / 64)
        spots = [[target.x_m, target.y_m, 0.0] for target in seen.targets if target.present]
        assert np.array(targets[seen.tick]) == pytest.approx(np.array(spots), abs=1 / 64)


def test_frames_that_were_lost_are_drawn(flown: tuple[Path, list[Observation]]) -> None:
    path, observations = flown
    lines = _rows(path, "/world/broken", "LineStrips3D:strips")
    assert {tick: len(batch) for tick, batch in lines.items()} == {
        seen.tick: len(seen.broken) for seen in observations if seen.tick % 2 == 0
    }
    assert sum(len(seen.broken) for seen in observations) == observations[-1].totals.radio_lost > 0


def test_a_page_says_what_was_known_wanted_and_how_wrong_it_was() -> None:
    scene = toy_scene()
    seen = next(iter(toy_observations(scene, ticks=1)))
    truth = seen.targets[5]
    belief = Belief(
        target=5,
        place_m=(truth.x_m + 3.0, truth.y_m - 4.0),
        age_s=2.5,
        owner=7,
        caller=7,
        loss_in_s=6.0,
        answerer=4,
        capture_s=4.0,
    )
    known = Knowledge(
        beliefs=(belief,), mates=(Mate(7, (0.0, 0.0), 12.0),), wanted_m_s=(0.3, 0.4), why="flies to T5: A7 loses it"
    )
    text = page(scene, AgentStatus(uid=4, activity=Activity.HELPING, knowledge=known), seen)
    assert "### A4: helping at 0.0 s" in text
    assert "**flies to T5: A7 loses it** (at 0.5 m/s)" in text
    row = next(line for line in text.splitlines() if line.startswith("| T5"))
    assert [cell.strip() for cell in row.strip("|").split("|")][2:] == [
        "2.5 s ago", "A7", "A7", "6.0 s", "A4", "4.0 s", "5.0 m",
    ]  # fmt: skip
    assert text.endswith("It hears A7, 12 s ago.")


@pytest.mark.parametrize("opening_deg", [60.0, 120.0, 240.0])
def test_the_ground_is_seen_as_the_sensor_sees(opening_deg: float) -> None:
    scene = replace(toy_scene(n_agents=2), sensing_ranges_m=(10.0, 25.0), half_opening_rad=opening_deg * pi / 360)
    cos_half = cos(scene.half_opening_rad)
    places = np.array([[60 * (draw(1, k, axis, 990) - 0.5) for axis in range(2)] for k in range(400)])
    facing = np.array([(0.6, 0.8), (-1.0, 0.0)])
    for looking in ((True, False), (False, True), (True, True)):
        found = Sight(scene).covers(places.T, np.zeros((2, 2)), facing, np.array(looking))
        eyes = [(*facing[uid], range_m) for uid, range_m in enumerate(scene.sensing_ranges_m) if looking[uid]]
        truly = [any(sees(x, y, range_m, *ahead, cos_half) for *ahead, range_m in eyes) for x, y in places]
        assert found.tolist() == truly
        assert 0 < sum(truly) < len(truly)


def test_agents_look_along_their_course_once_the_mission_begins() -> None:
    scene = toy_scene()
    block = Block(scene, list(toy_observations(scene, ticks=PREPARATION + 30)))
    facings = Sight(scene).facings(block)
    at_first, last = facings[0], facings[PREPARATION + 29]
    assert np.array_equal(facings[PREPARATION - 1], at_first)
    for looks, truth in zip(last.tolist(), block.observations[-1].truths, strict=True):
        east, north = truth.velocity_m_s[:2]
        assert looks == pytest.approx([east / hypot(east, north), north / hypot(east, north)], abs=1e-6)


def test_an_outline_ends_where_sight_ends() -> None:
    scene = replace(toy_scene(n_agents=1), sensing_ranges_m=(8.0,), half_opening_rad=pi / 3)
    center = np.array([[100.0, -20.0, 0.0]], dtype=np.float32)
    (line,) = Sight(scene).outlines(center, np.array([(0.0, 1.0)]), np.array([0]))
    assert line[0].tolist() == line[-1].tolist() == center[0].tolist()
    away = line[1:-1, :2] - center[0, :2]
    assert all(isclose(sqrt(x * x + y * y), 8.0, abs_tol=0.02) for x, y in away)
    assert max(acos(min(1.0, y / hypot(x, y))) for x, y in away) == pytest.approx(pi / 3, abs=0.005)
