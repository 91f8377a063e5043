"""Whole missions, with real MAVLink, real zenoh and the real algorithm, short enough for every test run."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterable
from itertools import pairwise
from math import hypot
from pathlib import Path
from typing import Any

import pytest

from comms.clock import Lockstep, RealTime
from comms.session import open_local_bus
from comms.status import Activity
from missions.cli import main
from missions.flight import Flight
from missions.load import load_mission
from missions.metrics import Metrics
from missions.observation import Observation, Phase
from missions.overrides import Override
from missions.report import Report, as_json, make_report
from vehicle_sim.autopilot.ardupilot.modes import Mode

SMALL = ("agents.count=4", "targets.count=4", "duration_s=15", "vehicle.boot_s=0.5", "agents.altitude.base_m=4")
KEYS = {
    "mission", "policy", "seed", "agents", "targets", "duration_s", "coverage", "coverage_late", "coverage_floor",
    "utilization", "events", "help", "radio", "mavlink", "faults", "injected", "recording", "versions", "timing",
}  # fmt: skip


class Notes:
    """An observer that keeps everything."""

    def __init__(self) -> None:
        self.all: list[Observation] = []

    def observe(self, observation: Observation) -> None:
        self.all.append(observation)

    def of(self, phase: Phase) -> list[Observation]:
        return [observation for observation in self.all if observation.phase is phase]


def fly(name: str, *changes: str, stop_at_s: float = 1e9) -> tuple[Flight, Notes, Report]:
    mission = load_mission(name, overrides=[Override(text) for text in (*SMALL, *changes)])
    notes, metrics = Notes(), Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.run(pace=Lockstep(), observers=[metrics, notes], stop=lambda: flight.clock_s >= stop_at_s)
    return flight, notes, make_report(flight.side, metrics, wall_s=1.0, recording=None)


def without_timing(report: Report) -> Report:
    return {key: value for key, value in report.items() if key not in ("timing", "recording")}


def activities(observation: Observation) -> set[Activity]:
    return {status.activity for status in observation.statuses}


def test_a_mission_from_power_on_to_landed() -> None:
    flight, notes, report = fly("narrow")
    assert flight.complete
    assert set(report) == KEYS
    assert report["faults"] == []
    assert report["duration_s"] == 15.0
    assert report["coverage"] == 1.0  # four over four within 5 m
    assert report["mavlink"]["bad"] == report["mavlink"]["dropped"] == 0
    assert report["mavlink"]["vehicles"] == {"received": report["mavlink"]["sent"], "bad": 0, "dropped": 0}
    assert report["radio"]["delivered"] == 4 * 3 * 150
    assert json.loads(as_json(report)) == report
    assert activities(notes.all[-1]) == {Activity.LANDED}


def test_the_mission_begins_when_everybody_is_on_its_own_layer_above_its_home() -> None:
    flight, notes, _ = fly("quickstart")
    first = notes.of(Phase.MISSION)[0]
    homes = notes.all[0].truths
    for uid, (truth, home) in enumerate(zip(first.truths, homes, strict=True)):
        assert truth.position_m[2] == pytest.approx(4.0 + 2.0 * uid, abs=0.6)
        assert hypot(truth.position_m[0] - home.position_m[0], truth.position_m[1] - home.position_m[1]) < 0.5
    assert first.mission_tick == 0
    assert all(o.targets == notes.all[0].targets or not any(t.seen for t in o.targets) for o in notes.of(Phase.PREPARE))
    assert flight.ticks_flown == 150


def test_everybody_lands_at_its_own_home_and_knows_where_it_is() -> None:
    _, notes, _ = fly("quickstart", "vehicle.wind.speed_m_s=3", "vehicle.wind.gust_m_s=1")
    for before, after in zip(notes.all[0].truths, notes.all[-1].truths, strict=True):
        assert after.position_m == pytest.approx(before.position_m, abs=1.0)
    for observation in notes.of(Phase.MISSION):
        for truth, status in zip(observation.truths, observation.statuses, strict=True):
            assert status.position_m == pytest.approx(truth.position_m, abs=0.05)


def test_layers_are_kept_and_speeds_stay_within_the_mission() -> None:
    _, notes, _ = fly("narrow", "duration_s=30")
    for observation in notes.of(Phase.MISSION)[20:]:
        heights = sorted(truth.position_m[2] for truth in observation.truths)
        assert min(b - a for a, b in pairwise(heights)) > 1.5
        for truth in observation.truths:
            assert hypot(*truth.velocity_m_s[:2]) < 0.4 * 1.25


@pytest.mark.parametrize(
    "changes",
    [(), ("radio.loss=0.3", "radio.latency_s=0.25"), ("vehicle.kind=ideal", "radio.mode=ideal"), ("seed=99",)],
)
def test_the_same_mission_gives_the_same_report_and_the_same_flight(changes: tuple[str, ...]) -> None:
    _, notes, report = fly("quickstart", *changes)
    _, again, report_again = fly("quickstart", *changes)
    assert without_timing(report) == without_timing(report_again)
    assert notes.all == again.all


def test_another_seed_is_another_flight() -> None:
    first, second = fly("quickstart")[1], fly("quickstart", "seed=2")[1]
    assert first.all[0].targets != second.all[0].targets


@pytest.mark.parametrize(
    "changes",
    [
        ("targets.motion=random",),
        ("targets.motion=static",),
        ("arena={shape: rectangle, width_m: 40, height_m: 50}",),
        ("policy.explore=stale-first",),
        ("policy={predictor: none}",),
        ("policy={call: predicted, answer_gate: in_time, capture: worst_case, help_margin_s: 2, memory_s: 0}",),
        ("policy.standoff_m=1",),
        ("agents.count=1",),
        ("tick_s=0.2",),
        ("vehicle.flavor=px4",),
        ("vehicle.flavor=px4", "tick_s=0.4", "policy={tag_lease_s: 1, help_lease_s: 2}"),
        ("vehicle={flavor: px4, kind: ideal}",),
    ],
)
def test_every_choice_flies(changes: tuple[str, ...]) -> None:
    flight, _, report = fly("quickstart", "duration_s=5", *changes)
    assert flight.complete
    assert report["faults"] == []
    assert 0.0 <= report["coverage"] <= 1.0


@pytest.mark.parametrize(
    "changes",
    [
        ("agents.altitude.base_m=2", "vehicle.limits.tilt_deg=1"),
        ("agents.altitude.base_m=494",),
        ("agents.speed_m_s=0.1", "targets.speed_m_s=0.05"),
        ("agents.speed_m_s=50", "vehicle.limits.speed_m_s=100"),
        ("vehicle.limits={speed_m_s: 1, acceleration_m_s2: 0.1, climb_m_s: 0.1, descent_m_s: 0.1}",),
        ("vehicle.boot_s=0",),
        ("vehicle.battery={capacity_mah: 999999, voltage_v: 0.001, hover_current_a: 0.001}",),
        ("arena.radius_m=50000", "agents.deployment.radius_m=5000", "targets.deployment.radius_m=50000"),
        ("tick_s=1", "policy.tag_lease_s=2", "policy.help_lease_s=2"),
        ("tick_s=0.01", "duration_s=1"),
        ("targets.count=300", "duration_s=2"),
        ("radio.latency_s=60", "policy.tag_lease_s=100", "policy.help_lease_s=100"),
    ],
)
def test_what_a_mission_may_be_can_be_flown(changes: tuple[str, ...]) -> None:
    mission = load_mission("narrow", overrides=[Override(text) for text in (*SMALL, *changes)])
    metrics = Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.run(pace=Lockstep(), observers=[metrics], stop=lambda: flight.clock_s > 30.0)
    assert [fault.what for fault in metrics.faults if not fault.what.startswith("stopped after")] == []


def test_an_agent_that_lands_in_the_mission_lets_go_of_its_targets_and_falls_silent() -> None:
    mission = load_mission("narrow", overrides=[Override(text) for text in (*SMALL, "duration_s=60")])
    notes, metrics = Notes(), Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)

        class Gremlin:
            def observe(self, observation: Observation) -> None:
                if observation.mission_tick == 100:
                    flight.vehicles[3].autopilot.set_mode(Mode.LAND)

        flight.run(pace=Lockstep(), observers=[metrics, notes, Gremlin()], stop=lambda: False)
    landed = [o.statuses[3] for o in notes.of(Phase.MISSION) if o.statuses[3].activity is Activity.LANDED]
    assert len(landed) > 100
    assert all(status.tags == () and status.helping is None for status in landed)
    assert [fault.agent for fault in metrics.faults] == [3, 3]
    assert flight.complete
    assert flight.side.medium.count.sent < 4 * 600 - 300  # silent since it left


def test_replayed_tracks_come_and_go() -> None:
    mission = load_mission("tracks", overrides=[Override("duration_s=5"), Override("vehicle.boot_s=0.5")])
    notes = Notes()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.run(pace=Lockstep(), observers=[notes], stop=lambda: False)
    assert flight.complete
    present = [sum(target.present for target in o.targets) for o in notes.of(Phase.MISSION)]
    assert 0 < present[0] <= len(flight.world.places)


def test_a_stop_brings_everybody_home_from_the_mission_and_from_the_takeoff() -> None:
    flight, notes, report = fly("quickstart", stop_at_s=12.0)
    assert not flight.complete
    assert 0.0 < report["duration_s"] < 15.0
    assert activities(notes.all[-1]) == {Activity.LANDED}
    flight, notes, report = fly("quickstart", stop_at_s=3.0)
    assert report["duration_s"] == 0.0
    assert report["coverage"] is None
    assert activities(notes.all[-1]) == {Activity.LANDED}


def test_real_time_takes_its_time_and_tells_its_lateness() -> None:
    waits = RealTime(tick_s=0.001, speed=1.0)
    lates = [waits.begin(tick) for tick in range(5)]
    assert all(late >= 0.0 for late in lates)
    mission = load_mission("narrow", overrides=[Override(text) for text in (*SMALL, "duration_s=2")])
    metrics = Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.run(pace=RealTime(tick_s=mission.tick_s, speed=1000.0), observers=[metrics], stop=lambda: False)
    assert flight.complete
    assert metrics.tick_late_s_max > 0.0  # a thousand times real time cannot be held


def launch(*arguments: str) -> int:
    return main(["launch", *arguments, *(word for text in SMALL for word in ("--set", text))])


def test_launch_writes_the_report_and_prints_the_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "report.json"
    assert launch("narrow", "--report", str(file), "--duration", "3") == 0
    assert json.loads(file.read_text())["duration_s"] == 3.0
    output = capsys.readouterr().out
    assert "coverage" in output
    assert "100.0%" in output


def test_a_report_on_standard_output_is_json_alone(capsys: pytest.CaptureFixture[str]) -> None:
    assert launch("narrow", "--report", "-", "--duration", "3") == 0
    captured = capsys.readouterr()
    assert json.loads(captured.out)["mission"] == "narrow"
    assert "coverage" in captured.err


@pytest.mark.parametrize("option", ["--report", "--record"])
def test_what_cannot_be_written_is_found_out_before_takeoff(option: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert launch("narrow", option, "/proc/nothing") == 2
    assert "/proc/nothing" in capsys.readouterr().err


def test_report_and_recording_are_two_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    same = str(tmp_path / "same")
    assert launch("narrow", "--report", same, "--record", same) == 2
    assert "allowed: another file" in capsys.readouterr().err


def test_unreadable_tracks_are_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tracks = tmp_path / "tracks.csv"
    tracks.write_text("t,id,x,y\n0,a,zero,0\n")
    assert main(["launch", "tracks", "--set", f"targets.file={tracks}"]) == 2
    error = capsys.readouterr().err
    assert f"{tracks}: line 2" in error
    assert "Traceback" not in error


def test_tracks_of_another_place_tell_where_home_must_be(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tracks = tmp_path / "far.csv"
    rows = "".join(f"2020-01-01 00:00:{s:02d}.000,10.5,45.25,a\n" for s in range(5))
    tracks.write_text("timestamp,location-long,location-lat,individual-local-identifier\n" + rows)
    assert main(["launch", "tracks", "--set", f"targets.file={tracks}"]) == 2
    assert capsys.readouterr().err == (
        f"{tracks}: targets.file: got tracks that are nowhere inside the arena; "
        "allowed: home: {latitude_deg: 45.2500000, longitude_deg: 10.5000000}\n"
    )


def test_the_same_mission_gives_the_same_recording(tmp_path: Path) -> None:
    pytest.importorskip("rerun")
    for name in ("first", "second"):
        assert launch("narrow", "--duration", "5", "--record", str(tmp_path / f"{name}.rrd")) == 0
    compare = ["rerun", "rrd", "compare", "--unordered", str(tmp_path / "first.rrd"), str(tmp_path / "second.rrd")]
    compare[0] = str(Path(sys.executable).with_name("rerun"))
    result = subprocess.run(compare, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr[-2000:]


def test_ctrl_c_lands_the_swarm_and_still_reports(tmp_path: Path) -> None:
    """A real process, a real signal: sent once the recording has begun."""
    pytest.importorskip("rerun")
    record, report = tmp_path / "flight.rrd", tmp_path / "report.json"
    command = [sys.executable, "-c", "import sys; from missions.cli import main; sys.exit(main(sys.argv[1:]))"]
    command += ["launch", "narrow", "--speed", "20", "--record", str(record), "--report", str(report)]
    command += [word for text in SMALL for word in ("--set", text)] + ["--duration", "600"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        _wait_for_growth(process, tmp_path / "flight.rrd.part")
        process.send_signal(2)
        output, _ = process.communicate(timeout=120)
    finally:
        process.kill()
    assert process.returncode == 130, output
    found: dict[str, Any] = json.loads(report.read_text())
    assert found["duration_s"] < 600.0
    assert [fault["what"][:14] for fault in found["faults"]] == ["stopped after "]
    assert record.stat().st_size > 10_000
    assert not (tmp_path / "flight.rrd.part").exists()


def _wait_for_growth(process: subprocess.Popen[str], file: Path) -> None:
    sizes: Iterable[float] = iter(lambda: file.stat().st_size if file.exists() else 0, -1)
    for size in sizes:
        if size > 60_000:
            return
        try:
            process.wait(timeout=0.2)
        except subprocess.TimeoutExpired:
            continue
        raise AssertionError(f"ended early: {process.communicate()[0]}")
