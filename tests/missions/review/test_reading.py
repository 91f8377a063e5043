"""What a review counts is what the mission reported, and hangs together."""

from __future__ import annotations

import gc
import json
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
import rerun as rr
from msgspec import structs
from rerun.chunk import Chunk, LazyChunkStream, RrdReader

from missions.cli import main
from missions.observation import Observation
from missions.problems import InputError
from missions.recording import Recorder
from missions.recording.optimize import rerun_command
from missions.recording.playback import Playback, play_back
from missions.recording.table import MISSION
from missions.review.calls import Fate
from missions.review.reading import read
from tests.missions.review.conftest import Flown
from tests.missions.toy_observations import toy_observations, toy_scene


def _read_back(path: Path) -> tuple[Playback, list[Observation]]:
    with play_back(path) as playback:
        return playback, list(playback.observations())


def _lasting(report: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in report.items() if key not in ("timing", "recording")}


def test_the_report_is_counted_again_from_the_recording_alone(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["review", str(flown.recording), "--json"]) == 0
    counted = json.loads(capsys.readouterr().out)
    assert _lasting(counted) == _lasting(flown.report)
    assert counted["timing"]["tick_late_s_max"] == flown.report["timing"]["tick_late_s_max"]
    assert counted["help"]["calls"] > 5
    assert counted["events"]["target_loss"] > 0
    assert counted["radio"]["lost"] > 0
    assert counted["faults"]
    assert counted["injected"][0]["noticed_by"] is not None


def test_every_call_and_loss_of_the_report_has_its_story(flown: Flown) -> None:
    review = flown.review
    assert len(review.calls) == flown.report["help"]["calls"]
    assert len(review.losses) == flown.report["events"]["target_loss"]
    for call in review.calls:
        assert call.began_s <= call.ended_s
        assert (call.owner is None) == (call.fate in (Fate.LOST, Fate.OPEN))
        assert (call.owner in call.helpers) == (call.fate is Fate.HANDED_OVER) or call.fate is Fate.KEPT
    for loss in review.losses:
        assert all(chance.leave_by_s <= loss.time_s and chance.agent not in loss.owners for chance in loss.chances)


def test_the_timeline_is_in_order_and_tells_every_loss(flown: Flown) -> None:
    times = [line.time_s for line in flown.review.lines]
    assert times == sorted(times)
    assert sum("any more" in line.text for line in flown.review.lines) == len(flown.review.losses)


@pytest.mark.parametrize("part_s", [None, 14.0], ids=["in one file", "in three files"])
def test_observations_come_back_as_they_were_made(tmp_path: Path, part_s: float | None) -> None:
    scene = toy_scene()
    made = list(toy_observations(scene, ticks=400))
    with Recorder(tmp_path / "toy.rrd", scene=scene, part_s=part_s) as recorder:
        for seen in made:
            recorder.observe(seen)
    names = ["toy.0002.rrd", "toy.0003.rrd", "toy.rrd"] if part_s else ["toy.rrd"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    _, read_back = _read_back(tmp_path / "toy.rrd")
    for old, new in zip(made, read_back, strict=True):
        assert (old.tick, old.phase, old.mission_tick, old.totals) == (
            new.tick,
            new.phase,
            new.mission_tick,
            new.totals,
        )
        assert (old.tick_late_s, old.events) == (new.tick_late_s, new.events)
        assert old.time_s == pytest.approx(new.time_s)
        for was, now in zip(old.statuses, new.statuses, strict=True):
            said = (was.activity, was.tags, was.helping, was.flight_mode, was.events)
            assert said == (now.activity, now.tags, now.helping, now.flight_mode, now.events)
            assert [(call.target, call.urgent) for call in was.calls] == [
                (call.target, call.urgent) for call in now.calls
            ]
        for place, again in zip(old.truths, new.truths, strict=True):
            assert again.position_m == pytest.approx(place.position_m, abs=1 / 128 + 1e-6)
        for target, same in zip(old.targets, new.targets, strict=True):
            assert (target.present, target.seen and target.present) == (same.present, same.seen)
            if target.present:
                assert (same.x_m, same.y_m) == pytest.approx((target.x_m, target.y_m), abs=1 / 128 + 1e-6)


def test_what_was_observed_is_in_memory_one_tick_at_a_time(tmp_path: Path) -> None:
    def alive() -> int:
        return sum(type(one) is Observation for one in gc.get_objects())

    scene = toy_scene()
    with Recorder(tmp_path / "toy.rrd", scene=scene, part_s=10.0) as recorder:
        for seen in toy_observations(scene, ticks=400):
            recorder.observe(seen)
    gc.collect()  # what other tests left
    before = alive()
    with play_back(tmp_path / "toy.rrd") as playback:
        most = max(alive() for seen in playback.observations() if seen.tick % 50 == 49)
    assert 1 <= most - before <= 2


def test_a_recorder_that_is_killed_in_a_later_file_leaves_all_of_them_to_be_read(tmp_path: Path) -> None:
    scene = toy_scene()
    with Recorder(tmp_path / "toy.rrd", scene=scene, part_s=10.0) as recorder:
        for seen in toy_observations(scene, ticks=400):
            recorder.observe(seen)
    last = tmp_path / "toy.0004.rrd"
    (tmp_path / "toy.0004.rrd.part").write_bytes(last.read_bytes()[:-100])
    last.unlink()
    (tmp_path / "toy.0005.rrd.part").touch()  # it was opened, and nothing was written
    playback, seen = _read_back(tmp_path / "toy.rrd")
    assert (playback.unfinished, playback.damaged) == (True, 0)
    assert [one.tick for one in seen] == list(range(len(seen)))
    assert 300 < len(seen) <= 400


def test_a_shorter_recording_of_the_same_name_takes_the_place_of_all_files_of_a_longer_one(tmp_path: Path) -> None:
    scene = toy_scene()
    for ticks in (400, 90):
        with Recorder(tmp_path / "toy.rrd", scene=scene, part_s=10.0) as recorder:
            for seen in toy_observations(scene, ticks=ticks):
                recorder.observe(seen)
    assert [path.name for path in tmp_path.iterdir()] == ["toy.rrd"]
    assert len(_read_back(tmp_path / "toy.rrd")[1]) == 90


def test_a_torn_recording_is_repaired_to_be_read_and_left_as_it_is(tmp_path: Path) -> None:
    scene, torn = toy_scene(), tmp_path / "torn.rrd.part"
    with Recorder(tmp_path / "whole.rrd", scene=scene) as recorder:
        for seen in toy_observations(scene, ticks=400):
            recorder.observe(seen)
        # As if it were killed now, in the middle of a message.
        torn.write_bytes((tmp_path / "whole.rrd.part").read_bytes()[:-100])
    before = torn.read_bytes()
    playback, seen = _read_back(torn)
    assert (playback.unfinished, playback.damaged) == (True, 0)
    # Five seconds wait in the queue at most, a second to be drawn, another is drawn; and a second is torn.
    assert 400 - 50 - 3 * 10 <= seen[-1].tick + 1 < 400
    assert playback.ticks_missing == 0
    assert torn.read_bytes() == before


def test_ticks_in_which_nobody_sends_are_ticks(tmp_path: Path) -> None:
    scene = toy_scene()
    seen = list(toy_observations(scene, ticks=120))
    silent = [replace(one, totals=seen[60].totals) if one.tick > 60 else one for one in seen]
    with Recorder(tmp_path / "toy.rrd", scene=scene) as recorder:
        for one in silent:
            recorder.observe(one)
    assert [one.tick for one in _read_back(tmp_path / "toy.rrd")[1]] == list(range(120))


def test_a_battery_is_what_was_heard_last_of_it_or_unknown(tmp_path: Path) -> None:
    scene = toy_scene()
    with Recorder(tmp_path / "toy.rrd", scene=scene) as recorder:
        for one in toy_observations(scene, ticks=60):
            heard = {0: None, 1: 0.75 if one.tick < 20 else None}
            statuses = [structs.replace(s, battery=heard.get(s.uid, s.battery)) for s in one.statuses]
            recorder.observe(replace(one, statuses=tuple(statuses)))
    last = _read_back(tmp_path / "toy.rrd")[1][-1]
    assert [status.battery for status in last.statuses[:2]] == [None, 0.75]


def test_a_recorder_that_came_late_or_dropped_ticks_says_so(tmp_path: Path) -> None:
    scene = toy_scene()
    with Recorder(tmp_path / "toy.rrd", scene=scene) as recorder:
        for one in toy_observations(scene, ticks=120):
            if one.tick >= 20 and one.tick not in range(50, 57):
                recorder.observe(one)
    assert _read_back(tmp_path / "toy.rrd")[0].ticks_missing == 27


@pytest.fixture
def unfinished(tmp_path: Path) -> bytearray:
    """A recording as it is while it is written, 60 observations of it on the disk at least."""
    scene = toy_scene()
    with Recorder(tmp_path / "toy.rrd", scene=scene) as recorder:
        for one in toy_observations(scene, ticks=120):
            recorder.observe(one)
        return bytearray((tmp_path / "toy.rrd.part").read_bytes())


def _add(chunk: Chunk, path: Path) -> None:
    """To a recording, behind all that is in it."""
    reader = RrdReader(path)
    entry, chunks = reader.recordings()[0], [*reader.stream(), chunk]
    LazyChunkStream.from_iter(chunks).write_rrd(
        path, application_id=entry.application_id, recording_id=entry.recording_id
    )


def _beginnings(content: bytes) -> list[int]:
    """Where each message of a recording begins."""
    begins, at = [], 12
    while at < len(content):
        begins.append(at)
        at += 16 + int.from_bytes(content[at + 8 : at + 16], "little")
    return begins


@pytest.mark.parametrize("where", [0.6, 0.75, 0.9])
@pytest.mark.parametrize("offset", [0, 8, 13, 30], ids=["kind", "length", "high byte of length", "store"])
def test_a_bad_byte_costs_little_of_a_recording(
    tmp_path: Path, unfinished: bytearray, where: float, offset: int
) -> None:
    begins = _beginnings(unfinished)
    unfinished[begins[round(where * len(begins))] + offset] ^= 0x55
    (tmp_path / "bad.rrd.part").write_bytes(unfinished)
    playback, seen = _read_back(tmp_path / "bad.rrd.part")
    assert len(seen) >= 50
    assert playback.damaged >= 1


@pytest.mark.parametrize(
    ("path", "tick", "columns"),
    [
        ("/ledger/duties", 70, {"helping": pa.array([1]), "flight_mode": pa.array(["GUIDED"])}),
        ("/ledger/tags", 70, {"agent": pa.array([99]), "target": pa.array([0])}),
        ("/ledger/phase", 70, {"phase": pa.array(["lunch"]), "mission_began_at": pa.array([50])}),
        ("/ledger/totals", 70, {"total": pa.array(["many"])}),
        ("/ledger/totals", 2**60, {"total": pa.array([1])}),
    ],
    ids=["too few", "no such agent", "no such phase", "not of its type", "a tick at another time"],
)
def test_what_makes_no_sense_is_left_out_and_told(
    tmp_path: Path, path: str, tick: int, columns: dict[str, pa.Array]
) -> None:
    scene = toy_scene()
    with Recorder(tmp_path / "toy.rrd", scene=scene) as recorder:
        for one in toy_observations(scene, ticks=120):
            recorder.observe(one)
    indexes = [
        rr.TimeColumn("tick", sequence=[tick]),
        rr.TimeColumn("mission_time", duration=[np.timedelta64(70 * 10**8, "ns")]),
    ]
    odd = Chunk.from_columns(path, indexes=indexes, columns=rr.AnyValues.columns(**columns))
    sound = _read_back(tmp_path / "toy.rrd")
    _add(odd, tmp_path / "toy.rrd")
    odd_one = _read_back(tmp_path / "toy.rrd")
    assert (sound[0].damaged, odd_one[0].damaged) == (0, 1)
    assert sound[1] == odd_one[1]


@pytest.mark.parametrize("key", ["agents", "targets"])
@pytest.mark.parametrize("said", [0, 11, 65546, -(2**63)])
def test_how_many_flew_is_what_the_rows_have_whatever_is_said(tmp_path: Path, key: str, said: int) -> None:
    scene = toy_scene()
    with Recorder(tmp_path / "toy.rrd", scene=scene) as recorder:
        for one in toy_observations(scene, ticks=60):
            recorder.observe(one)
    columns = rr.AnyValues.columns(**{key: pa.array([said])})
    _add(Chunk.from_columns(MISSION, indexes=[], columns=columns), tmp_path / "toy.rrd")
    playback, seen = _read_back(tmp_path / "toy.rrd")
    assert (playback.facts.agents, playback.facts.targets) == (scene.n_agents, scene.n_targets)
    assert playback.damaged == 1
    assert len(seen) == 60
    assert any(target.seen for target in seen[-1].targets)


def test_a_message_at_which_the_reader_crashes_is_left_out(
    tmp_path: Path, unfinished: bytearray, monkeypatch: pytest.MonkeyPatch
) -> None:
    begins, mark = _beginnings(unfinished), b"what no reader can bear"
    for where in (0.4, 0.8):
        at = begins[round(where * len(begins))] + 100
        unfinished[at : at + len(mark)] = mark
    (tmp_path / "bad.rrd.part").write_bytes(unfinished)
    tool = tmp_path / "rerun"
    tool.write_text(f"""#!/bin/sh
        for word; do
            grep -qs '{mark.decode()}' "$word" && exit 102
        done
        exec '{rerun_command()[0]}' "$@"
    """)
    tool.chmod(0o755)
    monkeypatch.setenv("RERUN_CLI_PATH", str(tool))
    playback, seen = _read_back(tmp_path / "bad.rrd.part")
    assert len(seen) >= 50
    assert playback.damaged >= 1


def test_a_name_that_is_no_utf_8_is_read(tmp_path: Path) -> None:
    scene, odd = toy_scene(), tmp_path / os.fsdecode(b"n\xff.rrd")
    with Recorder(tmp_path / "toy.rrd", scene=scene) as recorder:
        for one in toy_observations(scene, ticks=30):
            recorder.observe(one)
    try:
        (tmp_path / "toy.rrd").rename(odd)
    except OSError:
        pytest.skip("this file system has no such names")
    assert len(_read_back(odd)[1]) == 30


@pytest.mark.parametrize("content", [b"", b"no recording", b"RRF2" + bytes(200)])
def test_what_is_no_recording_is_bad_input(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "odd.rrd"
    path.write_bytes(content)
    with pytest.raises(InputError, match="got no recording"):
        read(path)
    with pytest.raises(InputError, match="got no file"):
        read(tmp_path / "missing.rrd")
    path.rename(tmp_path / "odd.tlog")
    with pytest.raises(InputError, match="swarm import makes of it"):
        read(tmp_path / "odd.tlog")


def test_a_mission_that_is_not_understood_is_bad_input(tmp_path: Path) -> None:
    scene = toy_scene()  # its mission file has none of the keys that a review asks for
    with Recorder(tmp_path / "toy.rrd", scene=scene) as recorder:
        for seen in toy_observations(scene, ticks=30):
            recorder.observe(seen)
    with pytest.raises(InputError, match="got a mission that this version does not understand"):
        read(tmp_path / "toy.rrd")
