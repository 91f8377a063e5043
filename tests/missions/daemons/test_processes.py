"""Whole missions in many processes: the same decisions, and what becomes of those who die."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from missions.daemons.agent import HOME_FIRST
from missions.daemons.feed import UNAWAITED
from missions.daemons.options import fingerprint
from missions.daemons.wire import TAKEN
from missions.flightlog import FlightLog
from missions.load import load_mission
from missions.tlog import log_of
from tests.missions.daemons.swarm import (
    COMMAND,
    FOR_EVER_S,
    ROOT,
    SMALL,
    children,
    free_endpoint,
    kill,
    swarm,
    wait_until_gone,
)

PATIENT_S = 150.0  # of mission, at ten times real time: a process has long started by then, on a busy computer too
LONG = ("--speed", "10", "--duration", str(FOR_EVER_S), "--log-level", "info")

BROKEN_OFF = "the flight was broken off: at once, in the air or not"


def report_of(file: Path) -> dict[str, Any]:
    report: dict[str, Any] = json.loads(file.read_text())
    return report


def decided(file: Path) -> dict[str, Any]:
    return {key: value for key, value in report_of(file).items() if key not in ("timing", "recording")}


def agent_pid(launcher: int, uid: int) -> int:
    [pid] = [pid for pid, words in children(launcher).items() if words.rstrip().endswith(f"--id {uid}")]
    return pid


FAULTS = (
    "faults=[{kind: kill, at_s: 4, for_s: 5, agents: [1]}, {kind: freeze, at_s: 6, for_s: 4, agents: [2]}, "
    "{kind: partition, at_s: 12, for_s: 3, groups: [[0], [1, 2]]}, {kind: kill, at_s: 17, agents: [0]}]"
)


@pytest.mark.parametrize(
    ("changes", "per_process"),
    [
        ((), 1),
        (("--set", "radio.loss=0.3", "--set", "radio.latency_s=0.25"), 1),
        (("--set", FAULTS), 1),
        ((), 2),
    ],
    ids=["plain", "lossy", "faulty", "two in a process"],
)
def test_many_processes_decide_what_one_does(tmp_path: Path, changes: tuple[str, ...], per_process: int) -> None:
    one, many = tmp_path / "one.json", tmp_path / "many.json"
    mission = ("launch", "quickstart", *SMALL, "--duration", "20", *changes)
    processes = ("--processes", str(per_process), "--listen", free_endpoint())
    for file, words in ((one, ()), (many, processes)):
        with swarm(*mission, "--report", str(file), "--tlog", str(file.with_suffix("")), *words) as run:
            assert run.wait() == 0, run.output
    assert decided(one) == decided(many)
    for uid in range(3):
        logs = [frames_of(log_of(file.with_suffix(""), uid)) for file in (one, many)]
        assert logs[0] == logs[1]
        assert len(logs[0]) > 100
    assert report_of(many)["radio"]["delivered"] > 0


def frames_of(log: Path) -> list[bytes]:
    """The frames of a telemetry log, without the times in front of them: eight bytes each, of MAVLink 2."""
    data, found, at = log.read_bytes(), [], 0
    while at < len(data):
        size = 12 + data[at + 9] + (13 if data[at + 10] & 1 else 0)  # a signature is 13 bytes
        found.append(data[at + 8 : at + 8 + size])
        at += 8 + size
    return found


@pytest.mark.slow
def test_a_whole_mission_and_its_recording_are_the_same(tmp_path: Path) -> None:
    pytest.importorskip("rerun")
    for name, words in (("one", ()), ("many", ("--processes", "--listen", free_endpoint()))):
        files = ("--report", str(tmp_path / f"{name}.json"), "--record", str(tmp_path / f"{name}.rrd"))
        with swarm("launch", "quickstart", *files, *words) as run:
            assert run.wait() == 0, run.output
    assert decided(tmp_path / "one.json") == decided(tmp_path / "many.json")
    rerun = str(Path(sys.executable).with_name("rerun"))
    compare = [rerun, "rrd", "compare", "--unordered", str(tmp_path / "one.rrd"), str(tmp_path / "many.rrd")]
    result = subprocess.run(compare, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr[-2000:]


@pytest.mark.parametrize(("words", "code"), [((), 1), (("--set", "agents.may_lose=1"), 0)], ids=["must not", "may"])
def test_an_agent_that_is_killed_is_lost_and_comes_back(tmp_path: Path, words: tuple[str, ...], code: int) -> None:
    file = tmp_path / "report.json"
    mission = ("quickstart", *SMALL, *LONG, "--duration", str(PATIENT_S), *words, "--report", str(file))
    files = ("--tlog", str(tmp_path))
    with swarm("launch", *mission, *files, "--processes", "--listen", free_endpoint()) as run:
        run.wait_for("the mission begins")
        kill(agent_pid(run.process.pid, 2), signal.SIGKILL)
        assert run.wait() == code, run.output
    report = report_of(file)
    whats = [(fault["agent"], fault["what"]) for fault in report["faults"]]
    assert (2, "its process has died, or its link is cut") in whats
    assert "agent 2 ended with code -9: started again" in run.output
    assert 'who=agent-2 text="landed and disarmed"' in run.output
    assert report["duration_s"] == PATIENT_S
    times = [[entry.unix_s for entry in FlightLog(log_of(tmp_path, uid).read_bytes())] for uid in range(3)]
    assert len({log[0] for log in times}) == 1  # one mission clock, whenever a process was started
    assert times[2] == sorted(times[2])
    assert times[2][-1] - times[2][0] > PATIENT_S


def test_an_agent_that_stands_still_is_lost_for_a_while_in_real_time(tmp_path: Path) -> None:
    file, endpoint = tmp_path / "report.json", free_endpoint()
    mission = ("quickstart", *SMALL, "--speed", "4", "--duration", str(FOR_EVER_S), "--log-level", "info")
    with (
        swarm("world", *mission, "--listen", endpoint, "--report", str(file)) as world,
        swarm("agent", *mission, "--connect", endpoint, "--id", "0-1") as others,
        swarm("agent", *mission, "--connect", endpoint, "--id", "2") as agent,
    ):
        world.wait_for("the mission begins")
        agent.process.send_signal(signal.SIGSTOP)
        world.wait_for('who=agent-2 text="no answer for')
        agent.process.send_signal(signal.SIGCONT)
        world.wait_for('who=agent-2 text="its process is back"')
        world.process.terminate()
        assert [world.wait(), others.wait(), agent.wait()] == [0, 0, 0], world.output + agent.output
    assert {fault["agent"] for fault in report_of(file)["faults"]} == {2, None}  # nobody: it was stopped


def test_when_the_launcher_is_killed_nobody_stays(tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    launch = ("launch", "quickstart", *SMALL, *LONG, "--report", str(file), "--processes", "--listen", free_endpoint())
    with swarm(*launch) as run:
        run.wait_for("the mission begins")
        family = list(children(run.process.pid))
        assert len(family) == 4
        run.process.kill()
        try:
            wait_until_gone(family)
        finally:
            for pid in family:
                kill(pid, signal.SIGKILL)
    assert report_of(file)["duration_s"] < FOR_EVER_S  # it was told, landed, and reported


def test_ctrl_c_lands_everybody(tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    launch = ("launch", "quickstart", *SMALL, *LONG, "--report", str(file), "--processes", "--listen", free_endpoint())
    with swarm(*launch) as run:
        run.wait_for("the mission begins")
        family = list(children(run.process.pid))
        run.process.send_signal(signal.SIGINT)
        assert run.wait() == 130, run.output
        wait_until_gone(family)
    assert run.output.count("landed and disarmed") == 3
    assert 0.0 < report_of(file)["duration_s"] < FOR_EVER_S


def test_an_agent_that_is_asked_to_end_lands_first_and_the_others_go_on(tmp_path: Path) -> None:
    file, endpoint = tmp_path / "report.json", free_endpoint()
    mission = ("quickstart", *SMALL, *LONG)
    with (
        swarm("world", *mission, "--listen", endpoint, "--report", str(file)) as world,
        swarm("agent", *mission, "--connect", endpoint, "--id", "0-1") as others,
        swarm("agent", *mission, "--connect", endpoint, "--id", "2") as agent,
    ):
        world.wait_for("the mission begins")
        agent.process.send_signal(signal.SIGTERM)
        assert agent.wait() == 0, agent.output
        assert "landed and disarmed" in agent.output
        assert world.process.poll() is None
        world.process.terminate()
        assert world.wait() == 0, world.output
        assert others.wait() == 0, others.output
    assert {fault["agent"] for fault in report_of(file)["faults"]} == {2, None}


@pytest.mark.parametrize("signals", [(signal.SIGKILL,), (signal.SIGTERM, signal.SIGTERM)], ids=["killed", "told twice"])
def test_agents_whose_world_ends_at_once_fly_home(signals: tuple[signal.Signals, ...]) -> None:
    endpoint = free_endpoint()
    mission = ("quickstart", *SMALL, *LONG)
    with (
        swarm("world", *mission, "--listen", endpoint) as world,
        swarm("agent", *mission, "--connect", endpoint, "--id", "0-2") as agents,
    ):
        world.wait_for("the mission begins")
        first, *second = signals
        world.process.send_signal(first)
        for number in second:
            world.wait_for("asked to end")  # two of a kind would be one
            world.process.send_signal(number)
        assert agents.wait() == 1, agents.output
    assert "the world has gone: flying home" in agents.output
    assert agents.output.count("landed and disarmed") == 3


def test_an_agent_that_the_mission_does_not_have_comes_and_goes() -> None:
    endpoint = free_endpoint()
    mission = ("narrow", "--set", "agents.count=2", "--listen", endpoint, "--join-timeout", "60")
    other = ("narrow", "--set", "agents.count=9", "--connect", endpoint, "--id", "8")
    with swarm("world", *mission) as world, swarm("agent", *other) as stranger:
        stranger.wait_for("ready")
        stranger.process.terminate()
        assert stranger.wait() == 0
        with pytest.raises(subprocess.TimeoutExpired):
            world.process.wait(1.0)


def test_a_mission_is_the_same_wherever_its_files_lie(tmp_path: Path) -> None:
    prints = []
    for folder, rows in (("a", "0,0,1,1"), ("b", "0,0,1,1"), ("c", "0,0,1,2")):
        here = tmp_path / folder
        here.mkdir()
        (here / "tracks.csv").write_text(f"t,id,x,y\n{rows}\n9,0,2,2\n")
        (here / "mine.yaml").write_text("name: mine\ntargets: {motion: tracks, file: tracks.csv}\n")
        prints.append(fingerprint(load_mission(str(here / "mine.yaml")), 1.0))
    assert prints[0] == prints[1] != prints[2]


def test_nobody_waits_for_ever() -> None:
    endpoint = free_endpoint()
    with swarm("agent", "quickstart", "--id", "0", "--connect", endpoint, "--join-timeout", "1") as agent:
        assert agent.wait() == 1
    assert "does `swarm world quickstart` run there?" in agent.output
    with swarm("world", "quickstart", "--listen", endpoint, "--join-timeout", "1") as world:
        assert world.wait() == 1
    assert "no sign of agent 0, 1, 2" in world.output


@pytest.mark.parametrize("change", [("--seed", "7"), ("--speed", "2")], ids=["mission", "pace"])
def test_who_has_another_mission_or_another_pace_is_not_let_in(change: tuple[str, str], tmp_path: Path) -> None:
    pytest.importorskip("rerun")
    endpoint = free_endpoint()
    one = ("narrow", "--set", "agents.count=1", "--listen", endpoint, "--join-timeout", "60")
    other = ("narrow", "--set", "agents.count=1", *change, "--connect", endpoint)
    recorder = (*other, "--record", str(tmp_path / "no.rrd"))
    with swarm("world", *one) as world, swarm("agent", *other, "--id", "0"), swarm("record", *recorder):
        world.wait_for('who=agent-0 text="has another mission, or another --speed')
        world.wait_for('who=recorder text="has another mission, or another --speed')


def test_a_second_process_of_an_agent_says_why_it_goes_and_changes_nothing(tmp_path: Path) -> None:
    one, two, endpoint = tmp_path / "one.json", tmp_path / "two.json", free_endpoint()
    mission = ("quickstart", *SMALL, "--duration", "20")
    with swarm("launch", *mission, "--report", str(one)) as alone:
        assert alone.wait() == 0, alone.output
    connect = ("agent", *mission, "--connect", endpoint, "--id")
    with (
        swarm("world", *mission, "--listen", endpoint, "--report", str(two)) as world,
        swarm(*connect, "1") as first,
    ):
        world.wait_for("and waits for 3 agents")  # from here on it hears who says hello first
        first.wait_for("ready")
        with swarm(*connect, "1") as second:
            assert second.wait() == 2, second.output + first.output
            assert TAKEN in second.output
        with swarm(*connect, "0") as other, swarm(*connect, "2") as another:
            assert [process.wait() for process in (world, first, other, another)] == [0, 0, 0, 0], world.output
    assert first.output.count("landed and disarmed") == 1
    assert decided(one) == decided(two)


def test_who_stood_still_and_was_replaced_brings_down_what_it_flew() -> None:
    endpoint = free_endpoint()
    mission = ("quickstart", *SMALL, "--speed", "4", "--duration", str(FOR_EVER_S), "--log-level", "info")
    connect = ("agent", *mission, "--connect", endpoint, "--id")
    with (
        swarm("world", *mission, "--listen", endpoint) as world,
        swarm(*connect, "0-1"),
        swarm(*connect, "2") as first,
    ):
        world.wait_for("the mission begins")
        first.process.send_signal(signal.SIGSTOP)
        world.wait_for('who=agent-2 text="no answer for')
        with swarm(*connect, "2"):
            world.wait_for('who=agent-2 text="its process is back"')
            first.process.send_signal(signal.SIGCONT)
            assert first.wait() == 2, first.output
            assert [text for text in (TAKEN, HOME_FIRST, "landed and disarmed") if text not in first.output] == []


def test_a_world_that_waits_for_its_recording_can_be_stopped(tmp_path: Path) -> None:
    pytest.importorskip("rerun")
    file, endpoint = tmp_path / "report.json", free_endpoint()
    mission = ("quickstart", *SMALL, "--speed", "10", "--duration", "2", "--log-level", "info")
    connect = (*mission, "--connect", endpoint)
    with (
        swarm("world", *mission, "--listen", endpoint, "--recorded", "--report", str(file)) as world,
        swarm("record", *connect, "--record", str(tmp_path / "q.rrd")) as recorder,
        swarm("agent", *connect, "--id", "0-2") as agents,
    ):
        world.wait_for("the mission begins")
        recorder.process.send_signal(signal.SIGSTOP)
        assert agents.wait() == 0, agents.output
        world.process.terminate()
        assert world.wait() == 1, world.output
    assert [fault["what"] for fault in report_of(file)["faults"]] == [UNAWAITED]


@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 0), (signal.SIGINT, 130)])
def test_a_world_that_nobody_has_come_to_may_be_asked_to_end(number: signal.Signals, code: int) -> None:
    endpoint = free_endpoint()
    with swarm("world", "narrow", "--listen", endpoint, "--log-level", "info") as world:
        world.wait_for(f"listens on {endpoint}")
        world.process.send_signal(number)
        assert world.wait() == code, world.output
    assert "asked to end before everybody was there" in world.output
    assert "level=error" not in world.output


@pytest.mark.parametrize("second", [signal.SIGTERM, signal.SIGINT])
@pytest.mark.parametrize("processes", [(), ("--processes",)], ids=["one process", "processes"])
def test_a_flight_that_is_ended_at_once_leaves_a_report_and_has_failed(
    tmp_path: Path, processes: tuple[str, ...], second: signal.Signals
) -> None:
    file = tmp_path / "report.json"
    mission = ("quickstart", *SMALL, "--speed", "10", "--duration", str(FOR_EVER_S))
    launch = ("launch", *mission, "--report", str(file), *processes, "--listen", free_endpoint())
    with swarm(*launch, within=("sh", "-c", 'exec "$@" >&2', "sh")) as run:
        run.wait_for("mission: 0:")
        run.process.send_signal(signal.SIGTERM)
        run.wait_for("Stopping")
        run.process.send_signal(second)
        assert run.wait() == (130 if second is signal.SIGINT else 1), run.output
    assert BROKEN_OFF in [fault["what"] for fault in report_of(file)["faults"]]


def test_two_worlds_do_not_share_a_port() -> None:
    endpoint = free_endpoint()
    with swarm("world", "narrow", "--listen", endpoint) as first:
        first.wait_for(f"listens on {endpoint}")
        for words in (("world", "narrow"), ("launch", "narrow", "--processes")):
            with swarm(*words, "--listen", endpoint) as second:
                assert second.wait() == 2
            assert "--listen: " in second.output
            assert "ddress already in use" in second.output
        assert first.process.poll() is None


def test_a_daemon_is_light() -> None:
    """What an agent's process loads, it would load on a companion computer."""
    code = "import sys, missions.daemons.agent, missions.daemons.verbs, missions.cli; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    tops = {name.partition(".")[0] for name in loaded.stdout.split()}
    assert "zenoh" in tops
    assert not tops & {"torch", "rerun", "numba", "numpy", "matplotlib", "pyarrow"}


def test_the_plan_of_processes_is_printed() -> None:
    words = (*COMMAND, "plan", "quickstart", "--processes", "4", "--seed", "3")
    printed = subprocess.run(words, capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert [line.split("  ")[0] for line in printed.splitlines()[-4:]] == [
        "world",
        "agents 0-3",
        "agents 4-7",
        "agents 8-9",
    ]
    assert "swarm agent quickstart --seed 3 --connect tcp/127.0.0.1:7447" in printed
