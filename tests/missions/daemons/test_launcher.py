"""The launcher at the end of its world: who still flies is waited for, and told of; a person may end that."""

from __future__ import annotations

import socket
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from missions.cli import main
from missions.daemons import launcher, processes
from missions.daemons.launcher import run_processes
from missions.daemons.processes import ProcessPlan
from missions.exit_codes import BAD_INPUT
from missions.problems import InputError
from missions.sides.phases import RETURN_LIMIT_S
from missions.tlog import log_of
from tests.missions.daemons.swarm import free_endpoint
from tests.patience import PATIENCE_S

WORLD_CODE = 3
SOME_LOOKS_S = 5 * launcher.LOOK_EVERY_S
AWAIT = f"""
import os, pathlib, signal, time
folder, deadline_s = pathlib.Path({{folder!r}}), time.monotonic() + {PATIENCE_S}
while not (folder / "told").exists() and time.monotonic() < deadline_s:
    time.sleep(0.01)
"""
LAND = AWAIT + '(folder / "landed").touch()'
# Two of a kind would be one.
HURRY = AWAIT + "[os.kill(os.getppid(), number) for number in (signal.SIGINT, signal.SIGTERM)]; time.sleep(600)"
KILLED = "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"
REPORTED = """
import pathlib
part = pathlib.Path("REPORT.part")
part.write_text("of this run")
part.replace("REPORT")
raise SystemExit(1)"""

NO_MISSION = (ProcessPlan(name="world", identity="world", words=("world", "no-such-mission"), vital=True),)
NEEDS_IPV6 = pytest.mark.skipif("not has_ipv6()", reason="no IPv6 here")


class Watcher(StringIO):
    """A person who lets programs that `AWAIT` it go on as soon as the launcher has said these words."""

    def __init__(self, folder: Path, words: str) -> None:
        super().__init__()
        self._folder = folder
        self._words = words

    def write(self, text: str) -> int:
        if self._words in " ".join(text.split()):
            (self._folder / "told").touch()
        return super().write(text)


def launched(folder: Path, agent: str, monkeypatch: pytest.MonkeyPatch) -> int:
    """The exit code of a launch whose world ends at once, with this program for its only agent."""
    monkeypatch.setattr(launcher, "SAY_EVERY_S", 0.1)
    monkeypatch.setattr(processes, "COMMAND", (processes.COMMAND[0], "-c"))
    plans = (
        ProcessPlan(name="world", identity="world", words=(f"raise SystemExit({WORLD_CODE})",), vital=True),
        ProcessPlan(name="agent 0", identity="agent-0", words=(agent.format(folder=str(folder)),)),
    )
    return run_processes(
        plans, endpoint=free_endpoint(), console=Console(file=Watcher(folder, "still under way: agent 0"))
    )


def has_ipv6() -> bool:
    """Whether this computer speaks IPv6 to itself."""
    try:
        with socket.create_server(("::1", 0), family=socket.AF_INET6):
            return True
    except OSError:
        return False


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", pytest.param("[::1]", marks=NEEDS_IPV6)])
def test_a_mission_meets_at_any_address_of_this_machine_that_is_free(host: str) -> None:
    family, address = (socket.AF_INET6, "::1") if host == "[::1]" else (socket.AF_INET, "127.0.0.1")
    with socket.create_server((address, 0), family=family) as server:
        endpoint = f"tcp/{host}:{server.getsockname()[1]}"
        with pytest.raises(InputError, match=r"a free port of this machine .*in use"):
            run_processes(NO_MISSION, endpoint=endpoint, console=Console(file=StringIO()))
    # Now it is free: it comes as far as its world, which is told a mission that is none.
    assert run_processes(NO_MISSION, endpoint=endpoint, console=Console(file=StringIO())) == BAD_INPUT


def test_a_launch_that_finds_its_port_taken_says_by_whom_and_leaves_older_logs_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    older = log_of(tmp_path, 0)
    older.write_bytes(b"of another flight")
    with socket.create_server(("127.0.0.1", 0)) as server:
        endpoint = f"tcp/127.0.0.1:{server.getsockname()[1]}"
        assert main(["launch", "narrow", "--processes", "--tlog", str(tmp_path), "--listen", endpoint]) == BAD_INPUT
    assert older.read_bytes() == b"of another flight"
    assert "as every launch with --speed does: --listen names another port" in capsys.readouterr().err


@pytest.mark.parametrize(
    "endpoint",
    ["", "tcp", "tcp/7447", "tcp/:7447", "udp/127.0.0.1:7447", "tcp/127.0.0.1:x", "tcp/127.0.0.1:99999", "tcp/[::1:7",
     "tcp/nobody.invalid:7447", "tcp/203.0.113.1:7447"],
)  # fmt: skip
def test_where_nobody_can_listen_is_said(endpoint: str) -> None:
    with pytest.raises(InputError, match=r"--listen: got .*; allowed: "):
        run_processes(NO_MISSION, endpoint=endpoint, console=Console(file=StringIO()))


def test_a_port_for_ground_stations_goes_with_one_process_and_why_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "narrow", "--processes", "--gcs", "udpout:127.0.0.1:14550"]) == BAD_INPUT
    assert "--gcs: not with --processes, where each vehicle is in another process" in capsys.readouterr().err


def test_agents_that_outlive_their_world_are_told_of_and_may_land(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert launched(tmp_path, LAND, monkeypatch) == WORLD_CODE
    assert (tmp_path / "landed").exists()
    assert launcher.LANDING_S > RETURN_LIMIT_S


def test_a_person_need_not_wait_for_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert launched(tmp_path, HURRY, monkeypatch) == 130


def said_of(
    plans: tuple[ProcessPlan, ...],
    monkeypatch: pytest.MonkeyPatch,
    report: Path | None = None,
    *,
    out: StringIO | None = None,
) -> str:
    """What a launch of these programs says."""
    monkeypatch.setattr(processes, "COMMAND", (processes.COMMAND[0], "-c"))
    out = out or StringIO()
    run_processes(plans, endpoint=free_endpoint(), console=Console(file=out, width=40), report=report)
    return " ".join(out.getvalue().split())


@pytest.mark.parametrize(
    ("identity", "restarts", "program", "said"),
    [
        ("agents-2-3", 1, KILLED, "crew ended with code -9: not started again (--restarts 1)"),
        ("agents-2-3", 0, KILLED, "crew ended with code -9: not started again (--restarts 0)"),
        ("agents-2-3", 1, "raise SystemExit(2)", "crew ended with code 2: not started again"),
        ("recorder", 0, KILLED, "crew ended with code -9: not started again"),
    ],
)
def test_who_is_dead_for_good_is_told_of_once(
    identity: str, restarts: int, program: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The world ends some looks after that was told.
    world = AWAIT.format(folder=str(tmp_path)) + f"time.sleep({SOME_LOOKS_S})"
    n_again = restarts if program == KILLED else 0
    plans = (
        ProcessPlan(name="world", identity="world", words=(world,), vital=True),
        ProcessPlan(name="crew", identity=identity, words=(program,), restarts=restarts),
    )
    again = "crew ended with code -9: started again " * n_again
    assert said_of(plans, monkeypatch, out=Watcher(tmp_path, "not started again")) == f"{again}{said}"


@pytest.mark.parametrize(
    ("program", "older", "said"),
    [
        (KILLED, False, "world ended with code -9: there is no report"),
        (KILLED, True, "world ended with code -9: there is no report, and REPORT is of an earlier run"),
        ("raise SystemExit(1)", True, "world ended with code 1: there is no report, and REPORT is of an earlier run"),
        ("raise SystemExit(2)", True, ""),  # it has said why
        (REPORTED, False, ""),
        (REPORTED, True, ""),
    ],
)
def test_a_world_that_left_no_report_is_told_of_and_an_older_one_is_not_taken_for_its(
    program: str, older: bool, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    report = tmp_path / "r.json"
    if older:
        report.write_text("older")
    words = (program.replace("REPORT", str(report)),)
    plans = (ProcessPlan(name="world", identity="world", words=words, vital=True),)
    assert said_of(plans, monkeypatch, report) == said.replace("REPORT", str(report))
    if older and program != REPORTED:
        assert report.read_text() == "older"
