"""The lane of the mission's own faults: it says what is in force, from the first tick to the last."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pyarrow as pa
import pytest

rr = pytest.importorskip("rerun")
from rerun.chunk import RrdReader  # noqa: E402

from missions.faults.schedule import spells_of  # noqa: E402
from missions.mission.faults import Kill, Loss  # noqa: E402
from missions.recording import Recorder  # noqa: E402
from missions.recording.hazards import LANE, NONE, states_of  # noqa: E402
from tests.missions.toy_observations import PREPARATION, toy_observations, toy_scene  # noqa: E402

KILL = Kill(kind="kill", at_s=2.0, for_s=3.0, agents=(1,))
LOSS = Loss(kind="loss", at_s=4.0, share=0.3)
BOTH = "kill: A1 + loss of 30%: all agents"
# Tenths of a second since MISSION began -> what holds from there on.
STORY = {20: "kill: A1", 40: BOTH, 50: "loss of 30%: all agents"}


@pytest.fixture(autouse=True)
def _strict(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RERUN_STRICT", "1")


def _lane(path: Path) -> dict[int, str]:
    chunks = RrdReader(path).stream().filter(content=LANE, components="StateChange:state").to_chunks()
    batches = [pa.record_batch(chunk.to_record_batch()) for chunk in chunks]
    rows = (zip(*(b.column(name).to_pylist() for name in ("tick", "StateChange:state")), strict=True) for b in batches)
    return {tick: state for some in rows for tick, (state,) in some}


@pytest.mark.parametrize("part_s", [None, 6.0])
def test_the_lane_says_what_is_in_force_in_every_file(tmp_path: Path, part_s: float | None) -> None:
    scene = replace(toy_scene(), faults=spells_of((KILL, LOSS), 0.1))
    ticks = PREPARATION + 70
    with Recorder(tmp_path / "toy.rrd", scene=scene, part_s=part_s) as recorder:
        for seen in toy_observations(scene, ticks=ticks):
            recorder.observe(seen)
    changes = {0: NONE} | {PREPARATION + tick: state for tick, state in STORY.items()}
    files = list(tmp_path.iterdir())
    assert len(files) == (1 if part_s is None else -(-ticks // 60))
    told = _lane(tmp_path / "toy.rrd")
    assert told == {tick: state for tick, state in changes.items() if part_s is None or tick < 60}
    for number in range(2, len(files) + 1):
        first = 60 * (number - 1)
        told = _lane(tmp_path / f"toy.{number:04d}.rrd")
        assert told[first] == changes[max(tick for tick in changes if tick <= first)]


def test_every_state_has_a_color() -> None:
    assert states_of(spells_of((KILL, LOSS), 0.1)) == [NONE, *sorted(STORY.values())]


def test_a_mission_without_faults_has_no_such_lane(tmp_path: Path) -> None:
    scene = toy_scene()
    with Recorder(tmp_path / "toy.rrd", scene=scene) as recorder:
        for seen in toy_observations(scene, ticks=30):
            recorder.observe(seen)
    assert not RrdReader(tmp_path / "toy.rrd").stream().filter(content=LANE).to_chunks()
