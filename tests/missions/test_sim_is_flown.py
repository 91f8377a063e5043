"""The real thing end to end: `swarm sim` processes, sockets on loopback, a mission over them in real time."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from comms.mavlink import Endpoint
from comms.transport import transport_of
from missions.cli import main
from tests.missions.test_pilot_flies_vehicle import mode_command

pytestmark = pytest.mark.slow

COMMAND = [sys.executable, "-c", "import sys; from missions.cli import main; sys.exit(main(sys.argv[1:]))"]
HOMES = ("--home=-35.363262,149.165237,584,0", "--home=-35.363232,149.165297,584,0")
PATIENCE_S = 30.0
GUIDED, BRAKE = 4, 17


class Sim:
    """A `swarm sim` process on `port` (0: a free one), ready when it has said where it listens."""

    def __init__(self, home: str, system_id: int, port: int = 0) -> None:
        arguments = ["sim", "--port", str(port), "--sysid", str(system_id), "--boot", "3", home]
        self._process = subprocess.Popen([*COMMAND, *arguments], stdout=subprocess.PIPE, text=True)
        assert self._process.stdout is not None
        first = self._process.stdout.readline()
        found = re.search(r"tcpin:127\.0\.0\.1:(\d+)", first)
        assert found, first
        self.port = int(found[1])

    def end(self, kill: Callable[[subprocess.Popen[str]], None] = subprocess.Popen.terminate) -> None:
        kill(self._process)
        self._process.wait(timeout=PATIENCE_S)
        assert self._process.stdout is not None
        self._process.stdout.close()


def choose_mode(port: int, mode: int) -> None:
    """What a ground station on the same port does: another client, another system id."""
    station = Endpoint(system_id=254, component_id=190)
    station.send(mode_command(mode, system_id=1))
    with transport_of(f"tcp:127.0.0.1:{port}") as client:
        started_s = time.monotonic()
        while not client.connected and time.monotonic() - started_s < PATIENCE_S:
            client.read(time.monotonic())
            time.sleep(0.01)
        client.write(station.take())


def test_two_vehicles_fly_one_is_taken_and_given_back_and_one_is_killed_and_started_again(tmp_path: Path) -> None:
    sims = [Sim(HOMES[0], 1), Sim(HOMES[1], 9)]
    links = [f"tcp:127.0.0.1:{sim.port}" for sim in sims]
    report = tmp_path / "report.json"
    changes = [
        "agents={count: 2, speed_m_s: 3, altitude: {base_m: 5}, sensing: {range_m: 8}}",
        "targets={count: 2, speed_m_s: 1, deployment: {radius_m: 8}}",
        "duration_s=40",
        f"vehicle={{kind: link, links: {json.dumps(links)}}}",
    ]

    def restart() -> None:
        sims[1].end(subprocess.Popen.kill)
        sims[1] = Sim(HOMES[1], 9, sims[1].port)

    events = (
        (20.0, lambda: choose_mode(sims[0].port, BRAKE)),
        (25.0, restart),
        (28.0, lambda: choose_mode(sims[0].port, GUIDED)),
    )
    timers = [threading.Timer(after_s, what) for after_s, what in events]
    for timer in timers:
        timer.start()
    try:
        arguments = [word for text in changes for word in ("--set", text)]
        code = main(["launch", "quickstart", *arguments, "--report", str(report)])
    finally:
        for timer in timers:
            timer.cancel()
            timer.join(timeout=PATIENCE_S)
        for sim in sims:
            sim.end()
    found = json.loads(report.read_text())
    assert code == os.EX_OK
    assert found["duration_s"] == 40.0
    assert found["coverage"] > 0.5
    assert found["mavlink"]["bad"] == 0
    told = [(fault["agent"], fault["what"]) for fault in found["faults"]]
    assert {(0, "leaves the mission: taken over"), (1, "the motors are off in flight")} <= set(told)
