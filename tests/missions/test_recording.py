"""What is in a recording, read back from the file; and how the recorder behaves when things go wrong."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from urllib.request import urlopen

import numpy as np
import pyarrow as pa
import pytest
import rerun as rr
from rerun.chunk import RrdReader

from comms.status import Activity, AgentStatus, Event, HelpCallStatus, Level
from missions.cli import main
from missions.exit_codes import FAILED
from missions.observation import Observation
from missions.recording import Recorder, RecordingError, Scene, optimize
from missions.recording.block import Block
from missions.recording.ledger import Ledger
from missions.recording.names import begins_in
from missions.recording.optimize import rerun_command
from missions.recording.palette import ACTIVITY_INKS, GROUND, GROUND_FRESH, LEVEL_INKS
from missions.recording.playback import play_back
from missions.recording.shapes import ground_mesh
from tests.missions.toy_observations import PREPARATION, toy_observations, toy_scene
from tests.patience import PATIENCE_S, until

TICKS = 400


@pytest.fixture(autouse=True)
def _strict() -> Iterator[None]:
    before = rr.strict_mode()
    rr.set_strict_mode(True)
    yield
    rr.set_strict_mode(before)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return toy_scene()


@pytest.fixture(scope="module")
def observations(scene: Scene) -> list[Observation]:
    return list(toy_observations(scene, ticks=TICKS))


@pytest.fixture(scope="module")
def recording(scene: Scene, observations: list[Observation], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return _record(tmp_path_factory.mktemp("recording") / "toy.rrd", scene, observations)


def _record(path: Path, scene: Scene, observations: list[Observation]) -> Path:
    recorder = Recorder(path, scene=scene)
    _watch(recorder, observations)
    assert recorder.dropped == 0
    return path


def _watch(recorder: Recorder, observations: Iterable[Observation]) -> None:
    with recorder:
        for observation in observations:
            recorder.observe(observation)


def _column(path: Path, entity: str, component: str, *, static: bool = False) -> dict[int, list[object]]:
    """Tick -> the batch logged at that tick (0 -> the only one, when static)."""
    chunks = RrdReader(path).stream().filter(content=entity, components=component, is_static=static).to_chunks()
    found: dict[int, list[object]] = {}
    for chunk in chunks:
        batch = pa.record_batch(chunk.to_record_batch())
        values = batch.column(component).to_pylist()
        ticks = [0] * len(values) if static else batch.column("tick").to_pylist()
        found |= {tick: value for tick, value in zip(ticks, values, strict=True) if value is not None}
    return dict(sorted(found.items()))


def _compare(one: Path, other: Path) -> int:
    command = [*rerun_command(), "rrd", "compare", "--unordered", str(one), str(other)]
    return subprocess.run(command, capture_output=True, check=False).returncode


class TestContent:
    def test_bodies_are_where_the_vehicles_truly_are(self, recording: Path, observations: list[Observation]) -> None:
        places = _column(recording, "/world/agents/body", "Points3D:positions")
        colors = _column(recording, "/world/agents/body", "Points3D:colors")
        assert list(places) == list(range(TICKS))
        for seen in observations[::37]:
            true = [truth.position_m for truth in seen.truths]
            assert np.array(places[seen.tick]) == pytest.approx(np.array(true), abs=1 / 128 + 1e-6)
            assert colors[seen.tick] == [ACTIVITY_INKS[status.activity] for status in seen.statuses]

    def test_mission_time_is_the_mission_clock(self, recording: Path) -> None:
        chunks = RrdReader(recording).stream().filter(content="/world/agents/body", has_timeline="tick").to_chunks()
        batch = pa.record_batch(next(iter(chunks)).to_record_batch())
        ticks = batch.column("tick").to_pylist()
        nanoseconds = batch.column("mission_time").cast(pa.int64()).to_pylist()
        assert nanoseconds == [tick * 100_000_000 for tick in ticks]

    @pytest.mark.parametrize(
        ("entity", "component"),
        [
            ("/world/tracks", "LineStrips3D:strips"),
            ("/world/links", "LineStrips3D:strips"),
            ("/world/help", "Arrows3D:vectors"),
            ("/world/targets/calls", "Cylinders3D:radii"),
        ],
    )
    def test_lines_come_and_go_with_what_they_stand_for(
        self, recording: Path, observations: list[Observation], entity: str, component: str
    ) -> None:
        def count(seen: Observation) -> int:
            return {
                "/world/tracks": sum(len(status.tags) for status in seen.statuses),
                "/world/links": len(seen.links),
                "/world/help": sum(status.helping is not None for status in seen.statuses),
                "/world/targets/calls": len({call.target for status in seen.statuses for call in status.calls}),
            }[entity]

        drawn = {tick: len(batch) for tick, batch in _column(recording, entity, component).items()}
        assert drawn == {seen.tick: count(seen) for seen in observations if seen.tick % 2 == 0}
        assert min(drawn.values()) < max(drawn.values())

    def test_absent_targets_have_neither_body_nor_name(self, recording: Path) -> None:
        bodies = _column(recording, "/world/targets/body", "Points3D:positions")
        names = _column(recording, "/world/targets/body", "Points3D:labels")
        assert [len(bodies[tick]) for tick in (0, 149, 150, 399)] == [9, 9, 10, 10]
        assert list(names) == [0, 150]
        assert "T3" not in names[0]
        assert names[150] == [f"T{target}" for target in range(10)]

    def test_a_lane_holds_changes_only(self, recording: Path, observations: list[Observation]) -> None:
        for uid in range(10):
            lane = _column(recording, f"/agents/A{uid}/mode", "StateChange:state")
            true = [seen.statuses[uid].activity.value for seen in observations]
            changes = [tick for tick in range(TICKS) if tick == 0 or true[tick] != true[tick - 1]]
            assert lane == {tick: [true[tick]] for tick in changes}

    def test_coverage_is_plotted_in_the_mission_alone(self, recording: Path, observations: list[Observation]) -> None:
        plotted = _column(recording, "/metrics/coverage", "Scalars:scalars")
        assert plotted == {
            seen.tick: [seen.coverage, seen.coverage_mean] for seen in observations if seen.tick >= PREPARATION
        }

    def test_events_are_logged_with_the_speaker(self, recording: Path) -> None:
        assert _column(recording, "/log/A6", "TextLog:text")[350] == ["A6  not heard for 3 s"]
        assert _column(recording, "/log/A6", "TextLog:level")[350] == ["ERROR"]
        assert _column(recording, "/log/mission", "TextLog:text") == {PREPARATION: ["mission  mission starts"]}

    def test_the_ground_is_bright_under_agents_and_stays_dark_elsewhere(
        self, recording: Path, scene: Scene, observations: list[Observation]
    ) -> None:
        painted = _column(recording, "/world/seen", "Mesh3D:vertex_colors")
        assert list(painted) == list(range(0, TICKS, 10))
        assert set(painted[0]) == {GROUND}
        vertices, _ = ground_mesh(scene.arena)
        for tick in (100, 390):
            agents = np.array([truth.position_m[:2] for truth in observations[tick].truths])
            awake = [s.activity is not Activity.LOST for s in observations[tick].statuses]
            away_m = np.linalg.norm(vertices[:, None] - agents[awake], axis=2)
            assert {painted[tick][vertex] for vertex in away_m.argmin(axis=0)} == {GROUND_FRESH}
        closest_m = np.min(
            [
                np.linalg.norm(vertices[:, None] - [truth.position_m[:2] for truth in seen.truths], axis=2).min(axis=1)
                for seen in observations[::10]
            ],
            axis=0,
        )
        # Paint bleeds over two vertices, 5 m each.
        never = closest_m > scene.sensing_ranges_m[0] + 15.0
        assert never.sum() > 50
        assert {painted[390][vertex] for vertex in np.flatnonzero(never)} == {GROUND}

    def test_the_mission_is_in_the_recording(self, recording: Path, scene: Scene) -> None:
        assert _column(recording, "/__properties/mission", "yaml", static=True) == {0: [scene.mission_yaml]}
        assert _column(recording, "/__properties/mission", "seed", static=True) == {0: [scene.seed]}
        assert _column(recording, "/__properties/versions", "git", static=True) == {0: ["0000000"]}


class TestRepeating:
    def test_equal_missions_give_equal_recordings(
        self, recording: Path, scene: Scene, observations: list[Observation], tmp_path: Path
    ) -> None:
        assert _compare(recording, _record(tmp_path / "again.rrd", scene, observations)) == 0

    def test_another_mission_gives_another_recording(
        self, recording: Path, scene: Scene, observations: list[Observation], tmp_path: Path
    ) -> None:
        changed = [*observations[:-2], replace(observations[-2], links=()), observations[-1]]
        assert _compare(recording, _record(tmp_path / "other.rrd", scene, changed)) != 0

    def test_samples_do_not_depend_on_how_a_run_is_cut(self, scene: Scene, observations: list[Observation]) -> None:
        whole = Block(scene, observations).every(1.0).ticks.tolist()
        for size in (1, 2, 7, 10):
            cut = [Block(scene, observations[start : start + size]) for start in range(0, TICKS, size)]
            assert [tick for block in cut for tick in block.every(1.0).ticks.tolist()] == whole
        assert whole == list(range(0, TICKS, 10))


class TestStory:
    def test_help_is_labeled_with_who_called(self, scene: Scene, tmp_path: Path) -> None:
        quiet = next(iter(toy_observations(scene, ticks=1)))
        idle = [AgentStatus(uid=uid, activity=Activity.EXPLORE) for uid in range(10)]

        def at(tick: int, **said: object) -> Observation:
            statuses = list(idle)
            for name, fields in said.items():
                uid = int(name[1:])
                statuses[uid] = AgentStatus(uid=uid, **fields)  # type: ignore[arg-type]
            return replace(quiet, tick=tick, time_s=tick / 10, statuses=tuple(statuses))

        calling = {"activity": Activity.CALLING, "calls": (HelpCallStatus(4, 2.5),)}
        helping = {"activity": Activity.HELPING, "helping": 4}
        ticks = [at(0), at(1, a2=calling), at(2, a2=calling, a7=helping), at(3, a2=calling, a7=helping), at(4)]
        path = _record(tmp_path / "story.rrd", scene, ticks)
        assert _column(path, "/world/help", "Arrows3D:labels") == {0: [], 2: ["A7 helps A2"], 4: []}

    def test_warnings_stand_out(self, scene: Scene, tmp_path: Path) -> None:
        quiet = next(iter(toy_observations(scene, ticks=1)))
        said = (Event(Level.WARNING, "low battery"), Event(Level.INFO, "hover"))
        first = AgentStatus(uid=0, activity=Activity.FOLLOW, events=said)
        path = _record(tmp_path / "w.rrd", scene, [replace(quiet, statuses=(first, *quiet.statuses[1:]))])
        chunks = RrdReader(path).stream().filter(content="/log/A0", is_static=False).to_chunks()
        batches = [pa.record_batch(chunk.to_record_batch()) for chunk in chunks]
        lines = {
            (level[0], color[0])
            for batch in batches
            for level, color in zip(
                batch.column("TextLog:level").to_pylist(), batch.column("TextLog:color").to_pylist(), strict=True
            )
        }
        assert lines == {("WARN", LEVEL_INKS[Level.WARNING]), ("INFO", ACTIVITY_INKS[Activity.FOLLOW])}


class TestLive:
    def test_a_page_for_browsers_is_served_on_this_machine_while_the_mission_lasts(
        self, scene: Scene, observations: list[Observation], tmp_path: Path
    ) -> None:
        path = tmp_path / "live.rrd"
        with Recorder(path, scene=scene, web=True) as recorder:
            assert recorder.page_url is not None
            assert recorder.server_url is not None
            assert "//127.0.0.1:" in recorder.page_url
            assert "//127.0.0.1:" in recorder.server_url
            for observation in observations:
                recorder.observe(observation)
            assert b"Rerun" in _fetch(recorder.page_url)
        assert list(_column(path, "/world/agents/body", "Points3D:positions")) == list(range(TICKS))
        with pytest.raises(OSError, match="refused"):
            urlopen(recorder.page_url, timeout=5.0)

    def test_the_page_ends_with_the_process_that_serves_it_even_if_it_is_killed(self) -> None:
        serving = "from missions.recording.watch import WebPage\nprint(WebPage('rerun+http://127.0.0.1:9/proxy').url)"
        command = [sys.executable, "-u", "-c", f"{serving}\ninput()"]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            url = process.stdout.readline().strip()
            assert b"Rerun" in _fetch(url)
            process.kill()
        until(lambda: not _answers(url))


def _answers(url: str) -> bool:
    try:
        urlopen(url, timeout=5.0).close()
        return True
    except OSError:
        return False


def _fetch(url: str) -> bytes:
    """What a server says that is about to start."""
    until(lambda: _answers(url))
    with urlopen(url, timeout=PATIENCE_S) as answer:
        found: bytes = answer.read()
        return found


class TestTrouble:
    def test_a_late_recorder_drops_and_counts(
        self, scene: Scene, observations: list[Observation], tmp_path: Path
    ) -> None:
        path = tmp_path / "hasty.rrd"
        recorder = Recorder(path, scene=scene, lossless=False)
        _watch(recorder, observations)
        kept = _column(path, "/world/agents/body", "Points3D:positions")
        assert len(kept) + recorder.dropped == TICKS
        assert len(kept) >= 50

    @pytest.mark.parametrize("lossless", [True, False])
    def test_a_failure_surfaces_at_close_and_hangs_nobody(
        self, scene: Scene, observations: list[Observation], tmp_path: Path, lossless: bool
    ) -> None:
        path = tmp_path / "broken.rrd"
        torn = replace(observations[5], truths=observations[5].truths[:3])
        recorder = Recorder(path, scene=scene, lossless=lossless)
        with pytest.raises(RecordingError, match=r"broken\.rrd\.part"):
            _watch(recorder, [*observations[:5], torn, *observations])
        assert not path.exists()
        assert path.with_name("broken.rrd.part").exists()

    def test_a_failed_mission_keeps_its_error_and_its_recording(
        self, scene: Scene, observations: list[Observation], tmp_path: Path
    ) -> None:
        path = tmp_path / "crash.rrd"
        failing = (observations[0] if tick == 0 else 1 / 0 for tick in range(2))
        with pytest.raises(ZeroDivisionError):
            _watch(Recorder(path, scene=scene), failing)  # type: ignore[arg-type]
        assert list(_column(path, "/world/agents/body", "Points3D:positions")) == [0]

    def test_where_nothing_was_observed_an_older_recording_stays(
        self, scene: Scene, observations: list[Observation], tmp_path: Path
    ) -> None:
        path = _record(tmp_path / "old.rrd", scene, observations[:20])
        before = path.read_bytes()
        with Recorder(path, scene=scene):
            pass
        assert [file.name for file in tmp_path.iterdir()] == ["old.rrd"]
        assert path.read_bytes() == before

    def test_what_a_crashed_flight_left_is_kept_when_it_is_flown_again(
        self, scene: Scene, observations: list[Observation], tmp_path: Path, caplog: pytest.LogCaptureFixture
    ) -> None:
        path = tmp_path / "flight.rrd"
        with Recorder(path, scene=scene) as recorder:
            for observation in observations:
                recorder.observe(observation)
            crashed = path.with_name("flight.rrd.part").read_bytes()
        path.unlink()
        path.with_name("flight.rrd.part").write_bytes(crashed)
        _record(path, scene, observations[:20])
        assert sorted(file.name for file in tmp_path.iterdir()) == ["flight.crashed.rrd", "flight.rrd"]
        ticks = _column(tmp_path / "flight.crashed.rrd", "/world/agents/body", "Points3D:positions")
        assert len(ticks) > 20
        assert "flight.crashed.rrd" in caplog.text

    @pytest.mark.parametrize("lost", [0, 100], ids=["whole", "torn"])
    def test_all_files_of_a_crashed_flight_are_kept(
        self, scene: Scene, observations: list[Observation], tmp_path: Path, caplog: pytest.LogCaptureFixture, lost: int
    ) -> None:
        path, more = tmp_path / "flight.rrd", tmp_path / "flight.0002.rrd"
        for _ in range(2):  # what was kept of an older one goes
            with Recorder(path, scene=scene, part_s=10.0) as recorder:
                for observation in observations[:180]:
                    recorder.observe(observation)
            content = more.read_bytes()
            more.with_name("flight.0002.rrd.part").write_bytes(content[: len(content) - lost])
            more.unlink()
        _record(path, scene, observations[:20])
        kept = ["flight.crashed.0002.rrd", "flight.crashed.rrd", "flight.rrd"]
        assert sorted(file.name for file in tmp_path.iterdir()) == kept
        assert all(str(tmp_path / name) in caplog.text for name in kept[:2])
        with play_back(tmp_path / "flight.crashed.rrd") as playback:
            assert [seen.tick for seen in playback.observations()][:101] == list(range(101))

    @pytest.mark.parametrize("content", [b"", b"no recording"])
    def test_a_crashed_file_of_which_nothing_can_be_read_costs_the_others_nothing(
        self, scene: Scene, observations: list[Observation], tmp_path: Path, content: bytes
    ) -> None:
        path = _record(tmp_path / "flight.rrd", scene, observations[:20])
        path.with_name("flight.0002.rrd.part").write_bytes(content)
        _record(path, scene, observations[:10])
        with play_back(tmp_path / "flight.crashed.rrd") as playback:
            assert len([*playback.observations()]) == 20

    def test_a_crashed_flight_that_cannot_be_repaired_is_kept_as_it_is(
        self, scene: Scene, observations: list[Observation], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        path = tmp_path / "flight.rrd"
        path.with_name("flight.rrd.part").write_bytes(b"as it is")
        monkeypatch.setenv("RERUN_CLI_PATH", str(tmp_path / "missing"))
        _record(path, scene, observations[:10])
        assert path.with_name("flight.crashed.rrd.part").read_bytes() == b"as it is"

    def test_it_begins_in_a_file_that_is_there(
        self, scene: Scene, observations: list[Observation], tmp_path: Path
    ) -> None:
        path = tmp_path / "flight.rrd"
        with Recorder(path, scene=scene, part_s=1.0) as recorder:
            assert begins_in(path) == tmp_path / "flight.rrd.part"
            for observation in observations[:80]:
                recorder.observe(observation)
        assert begins_in(path) == path

    def test_a_report_names_what_there_is_of_a_recording_that_failed(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(Ledger, "rows", lambda self, block: 1 / 0)
        report, files = tmp_path / "n.json", ["--report", str(tmp_path / "n.json"), "--record", str(tmp_path / "n.rrd")]
        assert main(["launch", "narrow", "--duration", "1", "--set", "agents.count=1", *files]) == FAILED
        named = Path(json.loads(report.read_text())["recording"])
        assert (named.name, named.is_file()) == ("n.rrd.part", True)

    def test_a_place_that_cannot_be_written_is_an_error_at_once(self, scene: Scene, tmp_path: Path) -> None:
        with pytest.raises(RecordingError, match="nowhere"), Recorder(tmp_path / "nowhere" / "a.rrd", scene=scene):
            pass

    def test_without_the_optimizer_the_recording_is_kept_as_it_is(
        self, scene: Scene, observations: list[Observation], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setenv("RERUN_CLI_PATH", str(tmp_path / "missing"))
        path = _record(tmp_path / "plain.rrd", scene, observations[:30])
        assert [entry.name for entry in tmp_path.iterdir()] == ["plain.rrd"]
        assert len(_column(path, "/world/agents/body", "Points3D:positions")) == 30

    @pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs SIGKILL")
    def test_a_kill_loses_a_second_at_most(self, tmp_path: Path) -> None:
        """The queue holds 50 ticks: of 150 observed, 100 were taken out, and all but the last second was flushed."""
        path = tmp_path / "killed.rrd"
        code = (
            "import os, signal, sys\n"
            "from missions.recording import Recorder\n"
            "from tests.missions.toy_observations import toy_observations, toy_scene\n"
            "scene = toy_scene()\n"
            "with Recorder(sys.argv[1], scene=scene) as recorder:\n"
            "    for observation in toy_observations(scene, ticks=150):\n"
            "        recorder.observe(observation)\n"
            "    os.kill(os.getpid(), signal.SIGKILL)\n"
        )
        environment = {**os.environ, "RERUN_STRICT": "1"}
        run = subprocess.run([sys.executable, "-c", code, str(path)], env=environment, check=False)
        assert run.returncode == -signal.SIGKILL
        assert not path.exists()
        optimize(path.with_name("killed.rrd.part"), path)
        kept = list(_column(path, "/world/agents/body", "Points3D:positions"))
        assert len(kept) >= 90
        assert kept == list(range(len(kept)))

    def test_a_torn_file_is_repaired(self, recording: Path, tmp_path: Path) -> None:
        torn, repaired = tmp_path / "torn.rrd.part", tmp_path / "torn.rrd"
        torn.write_bytes(recording.read_bytes()[:-200_000])
        optimize(torn, repaired)
        assert RrdReader(repaired).stream().to_chunks()

    def test_what_is_no_recording_is_refused(self, tmp_path: Path) -> None:
        with pytest.raises(RuntimeError, match="cannot optimize"):
            optimize(tmp_path / "missing.rrd", tmp_path / "out.rrd")
        assert list(tmp_path.iterdir()) == []


# Threads of other tests come and go, so each recording is made by a process of its own, which then waits.
RECORDING = """
import sys
from missions.recording import Recorder
from tests.missions.toy_observations import toy_observations, toy_scene
scene = toy_scene()
with Recorder(sys.argv[1], scene=scene, part_s=float(sys.argv[2])) as recorder:
    for seen in toy_observations(scene, ticks=60):
        recorder.observe(seen)
print("recorded", flush=True)
input()
"""


@contextmanager
def _recorded(path: Path, *, part_s: float) -> Iterator[Callable[[], int]]:
    """How many threads a process has that has recorded there, whenever it is asked."""
    command = [sys.executable, "-c", RECORDING, str(path), str(part_s)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "recorded\n"
            yield lambda: len(os.listdir(f"/proc/{process.pid}/task"))
        finally:
            process.kill()


def test_further_files_have_their_view_and_cost_no_threads_but_those_that_rerun_keeps_of_one_view(
    tmp_path: Path,
) -> None:
    with (
        _recorded(tmp_path / "short.rrd", part_s=60.0) as of_one,
        _recorded(tmp_path / "long.rrd", part_s=1.0) as of_six,
    ):
        until(lambda: of_six() <= of_one() + 2)  # threads end a little later
    parts = list(tmp_path.glob("long*"))
    assert len(parts) == 6
    assert all(len(RrdReader(part).blueprints()) == 1 for part in parts)
