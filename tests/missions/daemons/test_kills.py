"""Processes of a mission that are killed, or stand still: what goes on, what is told, and that nobody stays behind."""

from __future__ import annotations

import json
import re
import signal
from pathlib import Path

import pytest

from tests.missions.daemons.swarm import SMALL, Swarm, children, free_endpoint, kill, swarm, wait_until_gone

LAUNCH = ("launch", "quickstart", *SMALL, "--log-level", "info", "--processes")
# Long enough that a busy computer strikes before the end.
LOCKSTEP = ("--duration", "300")
MARK = "faults=[{kind: loss, at_s: 20, for_s: 1, share: 0.01}]"  # something that is told while it flies
IN_REAL_TIME = ("--speed", "6", "--duration", "40")


def pid_of(run: Swarm, *words: str) -> int:
    """The child whose command has these words."""
    [pid] = [pid for pid, command in children(run.process.pid).items() if set(words) <= set(command.split())]
    return pid


@pytest.mark.parametrize(
    "pace", [LOCKSTEP, pytest.param(IN_REAL_TIME, marks=pytest.mark.slow)], ids=["lockstep", "real time"]
)
def test_a_mission_goes_on_without_its_recorder_and_what_it_wrote_is_repaired(
    tmp_path: Path, pace: tuple[str, ...]
) -> None:
    pytest.importorskip("rerun")
    from missions.recording.playback import play_back

    report, recording = tmp_path / "report.json", tmp_path / "q.rrd"
    files = ("--report", str(report), "--record", str(recording), "--listen", free_endpoint())
    with swarm(*LAUNCH, *pace, "--set", MARK, *files) as run:
        run.wait_for("fault: loss")
        kill(pid_of(run, "record"), signal.SIGKILL)
        assert run.wait() == 1, run.output
    told = json.loads(report.read_text())
    assert told["duration_s"] == float(pace[-1])
    [what] = [fault["what"] for fault in told["faults"] if fault["agent"] is None]
    match = re.fullmatch(r"the recorder has gone: nothing is recorded from ([0-9.]+) s", what)
    assert match is not None, what
    assert not recording.exists()
    assert told["recording"] == str(recording.with_name("q.rrd.part"))
    with play_back(recording.with_name("q.rrd.part")) as kept:
        assert kept.unfinished
        *_, last = kept.observations()
    # A second that was not written yet; and what was on its way, which in lockstep may be some hundred ticks.
    assert float(match[1]) - last.time_s <= (3.0 if pace == IN_REAL_TIME else 30.0)


def test_an_agent_that_stands_still_is_lost_for_a_while_in_lockstep(tmp_path: Path) -> None:
    report = tmp_path / "report.json"
    with swarm(*LAUNCH, *LOCKSTEP, "--report", str(report), "--listen", free_endpoint()) as run:
        run.wait_for("the mission begins")
        frozen = pid_of(run, "agent", "2")
        kill(frozen, signal.SIGSTOP)
        run.wait_for("level=error who=agent-2")
        kill(frozen, signal.SIGCONT)
        assert run.wait() == 1, run.output
    told = json.loads(report.read_text())
    assert told["duration_s"] == float(LOCKSTEP[-1])
    assert {fault["agent"] for fault in told["faults"]} == {2}


@pytest.mark.slow
def test_when_the_world_is_killed_all_come_home_and_the_recording_is_whole(tmp_path: Path) -> None:
    pytest.importorskip("rerun")
    from missions.recording.playback import play_back

    recording = tmp_path / "q.rrd"
    with swarm(*LAUNCH, *IN_REAL_TIME, "--record", str(recording), "--listen", free_endpoint()) as run:
        run.wait_for("the mission begins")
        family = list(children(run.process.pid))
        kill(pid_of(run, "world"), signal.SIGKILL)
        assert run.wait() == 1, run.output
        wait_until_gone(family)
    assert run.output.count("landed and disarmed") == 3
    with play_back(recording) as playback:
        assert not playback.unfinished


def test_who_stands_still_goes_with_the_launcher_too(tmp_path: Path) -> None:
    pytest.importorskip("rerun")
    files = ("--record", str(tmp_path / "q.rrd"), "--listen", free_endpoint())
    with swarm(*LAUNCH, *IN_REAL_TIME, *files) as run:
        run.wait_for("the mission begins")
        family = list(children(run.process.pid))
        for words in (("agent", "2"), ("record",), ("world",)):
            kill(pid_of(run, *words), signal.SIGSTOP)
        run.process.kill()
        try:
            wait_until_gone(family)
        finally:
            for pid in family:
                kill(pid, signal.SIGKILL)
