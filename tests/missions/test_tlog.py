"""Telemetry logs hold every frame of a link, as pymavlink's reader finds them."""

from __future__ import annotations

import io
import json
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.framing import frames
from comms.mavlink import Endpoint
from missions.cli import main
from missions.tlog import Tlog

BEGAN_UNIX_S = 1_700_000_000.0


def _wire(*messages: object) -> bytes:
    end = Endpoint(system_id=7)
    for message in messages:
        end.send(message)
    return end.take()


def _read(path: Path) -> list[tuple[float, str]]:
    log = mavutil.mavlink_connection(str(path))
    found = []
    while (message := log.recv_match()) is not None:
        found.append((message._timestamp, message.get_type()))
    return found


HEARTBEAT = dialect.MAVLink_heartbeat_message(2, 3, 81, 0, 3, 3)
TIME = dialect.MAVLink_system_time_message(1, 2)


@pytest.mark.parametrize("cut", [1, 3, 9, 20, 21, 30])
def test_a_frame_cut_in_two_is_whole_in_the_log(tmp_path: Path, cut: int) -> None:
    wire = _wire(HEARTBEAT, TIME)
    path = tmp_path / "cut.tlog"
    with path.open("wb") as file:
        log = Tlog(file, began_unix_s=BEGAN_UNIX_S)
        log.pass_on(0.0, wire[:cut], b"")
        log.pass_on(0.1, wire[cut:], _wire(HEARTBEAT))
    assert [kind for _, kind in _read(path)] == ["HEARTBEAT", "SYSTEM_TIME", "HEARTBEAT"]


def test_a_full_disk_ends_the_log_and_not_the_flight() -> None:
    with open("/dev/full", "wb") as file:
        log = Tlog(file, began_unix_s=BEGAN_UNIX_S)
        for tick in range(50):
            log.pass_on(tick / 10, _wire(HEARTBEAT), _wire(TIME))
        assert log.failure is not None
        assert "No space left" in str(log.failure)
        log.close()


@pytest.mark.skipif(not hasattr(resource, "RLIMIT_FSIZE"), reason="needs a limit of a file's size")
def test_a_flight_whose_log_cannot_grow_comes_home_and_says_so(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "missions.cli", "launch", "narrow", "--duration", "5", "--set", "agents.count=2"]
    command += ["--tlog", str(tmp_path / "logs"), "--report", "-"]

    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    run = subprocess.run(command, capture_output=True, text=True, timeout=120, preexec_fn=limit)
    assert run.returncode == 1
    report = json.loads(run.stdout)
    assert report["duration_s"] == 5.0
    assert ["the telemetry logs are not whole" in fault["what"] for fault in report["faults"]] == [True]


def test_times_are_those_of_the_mission_clock(tmp_path: Path) -> None:
    path = tmp_path / "times.tlog"
    with path.open("wb") as file:
        log = Tlog(file, began_unix_s=BEGAN_UNIX_S)
        for now_s in (0.0, 0.1, 12.3):
            log.pass_on(now_s, _wire(HEARTBEAT), b"")
    assert [at - BEGAN_UNIX_S for at, _ in _read(path)] == pytest.approx([0.0, 0.1, 12.3], abs=1e-5)


def test_rubbish_between_frames_is_left_out() -> None:
    one, other = _wire(HEARTBEAT), _wire(TIME)
    assert frames(b"noise" + one + b"noise" + other + other[:8]) == ([one, other], other[:8])


def test_a_killed_process_loses_a_second_at_most() -> None:
    class Disk(io.BytesIO):
        safe = 0

        def flush(self) -> None:
            self.safe = len(self.getvalue())

    disk, wire = Disk(), _wire(HEARTBEAT)
    log = Tlog(disk, began_unix_s=BEGAN_UNIX_S)
    for tick in range(100):
        log.pass_on(tick * 0.1, wire, b"")
        unsafe = (len(disk.getvalue()) - disk.safe) / (8 + len(wire))
        assert unsafe <= 11


def test_a_launch_keeps_what_mavlogdump_reads(tmp_path: Path) -> None:
    folder = tmp_path / "deep" / "logs"
    assert main(["launch", "narrow", "--duration", "5", "--set", "agents.count=2", "--tlog", str(folder)]) == 0
    assert sorted(path.name for path in folder.iterdir()) == ["agent-0.tlog", "agent-1.tlog"]
    dump = Path(sys.executable).with_name("mavlogdump.py")
    command = [
        sys.executable,
        str(dump),
        "--types",
        "HEARTBEAT,SET_POSITION_TARGET_LOCAL_NED",
        str(folder / "agent-1.tlog"),
    ]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "autopilot : 3" in said  # the vehicle's heartbeats
    assert "type : 6" in said  # the agent's
    assert "SET_POSITION_TARGET_LOCAL_NED" in said
    assert "BAD_DATA" not in said


def test_a_folder_that_cannot_be_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["launch", "narrow", "--tlog", str(tmp_path / "file")]) == 2
    assert "--tlog: got" in capsys.readouterr().err
