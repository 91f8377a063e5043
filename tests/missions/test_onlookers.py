"""Whoever looks on may go: the flight goes on, lands, and leaves its report."""

from __future__ import annotations

import json
import signal
import subprocess
from pathlib import Path
from typing import Any

import pytest

from missions.daemons.fleet import result_table, status_table
from missions.daemons.orders import Answer, Report
from tests.missions.daemons.swarm import COMMAND, SMALL, children, free_endpoint, kill, swarm, wait_until_gone
from tests.patience import PATIENCE_S

FLIGHT = ("launch", "quickstart", *SMALL, "--duration", "40", "--speed", "20", "--listen", free_endpoint())


def flying(*words: str) -> subprocess.Popen[str]:
    """A flight whose mission has begun; both its outputs come by one pipe."""
    process = subprocess.Popen((*COMMAND, *words), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    wait_for(process, "mission: 0:")  # what it says of its port ends with "mission: ", too
    return process


def wait_for(process: subprocess.Popen[str], text: str) -> None:
    """Until it has said so."""
    assert process.stdout is not None
    said = ""
    while text not in said:
        line = process.stdout.readline()
        assert line, f"ended early: {said}"
        said += line


def close_pipe(process: subprocess.Popen[str]) -> None:
    assert process.stdout is not None
    process.stdout.close()


def report_of(file: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(file.read_text())
    return found


def test_a_pipe_that_nobody_reads_ends_no_flight(tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    process = flying(*FLIGHT, "--report", str(file))
    try:
        close_pipe(process)
        assert process.wait(PATIENCE_S) == 0
    finally:
        process.kill()
    assert report_of(file)["duration_s"] == 40.0
    assert report_of(file)["faults"] == []


def test_an_agent_that_comes_to_a_flight_of_one_process_is_told_that_it_is_one() -> None:
    endpoint = free_endpoint()
    process = flying(*FLIGHT, "--speed", "1", "--listen", endpoint)
    try:
        with swarm("agent", "quickstart", *SMALL, "--id", "0", "--connect", endpoint, "--speed", "1") as agent:
            agent.wait_for("quickstart flies there in one process, which lets nobody in")
    finally:
        process.kill()
        process.wait(PATIENCE_S)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_launch_that_is_asked_to_end_lands_first(number: int, tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    process = flying(*FLIGHT, "--duration", "4000", "--report", str(file))
    try:
        process.send_signal(number)
        if number == signal.SIGHUP:
            close_pipe(process)
        assert process.wait(PATIENCE_S) == 0
    finally:
        process.kill()
    [fault] = report_of(file)["faults"]
    assert fault["what"].startswith("stopped after ")  # and nobody was left in the air


def test_a_second_signal_ends_it_at_once_but_not_its_report(tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    process = flying(*FLIGHT, "--speed", "1", "--report", str(file))
    try:
        process.send_signal(signal.SIGINT)
        wait_for(process, "Stopping")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=PATIENCE_S)
    finally:
        process.kill()
    assert process.returncode == 130
    assert "broken off: at once" in report_of(file)["faults"][-1]["what"]


def test_daemons_land_when_their_launcher_goes_and_its_terminal_with_it(tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    words = ("--log-level", "info", "--report", str(file), "--processes", "--listen", free_endpoint())
    process = flying("launch", "quickstart", *SMALL, "--duration", "4000", *words)
    family: list[int] = []
    try:
        family = list(children(process.pid))
        assert len(family) == 4
        process.kill()
        close_pipe(process)
        wait_until_gone(family)
    finally:
        for pid in family:
            kill(pid, signal.SIGKILL)
        process.wait(PATIENCE_S)
    found = report_of(file)
    assert found["duration_s"] < 4000
    *left, stopped = [fault["what"] for fault in found["faults"]]
    assert set(left) <= {"leaves the mission: returning"}  # each process feels by itself that its launcher has gone
    assert stopped.startswith("stopped after ")


def test_a_review_that_nobody_reads_says_so_by_its_code() -> None:
    process = subprocess.Popen((*COMMAND, "plan", "reference"), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None
    process.stdout.close()
    _, said = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, said) == (141, b"")


def test_what_a_vehicle_says_of_itself_is_letters_and_nothing_else(capsys: pytest.CaptureFixture[str]) -> None:
    from rich.console import Console

    from comms.status import Activity

    wild = "[/x] [link=https://evil]\x1b[2J"
    how = Report(
        time_s=1.0, activity=Activity.FOLLOW, flight_mode=wild, battery=None, tags=(), mates=0, link=None,
        heard_ago_s=0.0, late_s=0.0, busy_s=0.0,
    )  # fmt: skip
    answers = {("quickstart", "0"): Answer(obeyed=True, text=wild, report=how)}
    console = Console(width=300)
    console.print(result_table(dict(answers)))
    console.print(status_table(dict(answers)))
    assert capsys.readouterr().out.count("[/x] [link=https://evil]?[2J") == 2
