"""MAVProxy flies a vehicle, by what a person types: `python -m tests.clients.mavproxy_session tcp:127.0.0.1:5760`."""

from __future__ import annotations

import re
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.clients.steps import expect, step, wait_for

MODULES = "log,signing,wp,rally,fence,ftp,param,arm,mode,cmdlong,misc,link,output"
HOME = (-35.363261, 149.165230, 584.0)  # of `swarm sim`
TAKEOFF, WAYPOINT, RETURN, POLYGON_INSIDE, RALLY = 22, 16, 20, 5001, 5100


class Terminal:
    """A running MAVProxy: what it prints, and its keyboard."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process
        self._lines: list[str] = []
        self._looked_at = 0
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self._lines.append(line.rstrip())

    def type(self, line: str) -> None:
        """Enter a line; what is printed from now on is looked at next."""
        assert self._process.stdin is not None
        self._looked_at = len(self._lines)
        self._process.stdin.write(f"{line}\n")
        self._process.stdin.flush()

    def printed(self, *patterns: str, timeout_s: float = 30.0) -> str:
        """The first line that matches the last of `patterns`, once all have been printed since the last `type`."""

        def found() -> str | None:
            lines = self._lines[self._looked_at :]
            hits = [next((m.group(0) for line in lines if (m := re.search(p, line))), None) for p in patterns]
            return hits[-1] if all(hits) else None

        try:
            return wait_for(" and ".join(patterns), found, timeout_s=timeout_s)
        except AssertionError as error:
            raise AssertionError(f"{error}; printed: {self._lines[self._looked_at :][-8:]}") from None

    def ask(self, line: str, *patterns: str, timeout_s: float = 30.0) -> str:
        self.type(line)
        return self.printed(*patterns, timeout_s=timeout_s)

    def set_parameter(self, name: str, value: float) -> None:
        self.type(f"param set {name} {value}")

        def stored() -> bool:
            self.type(f"param show {name}")
            time.sleep(0.3)
            return any(re.search(rf"{name} +{value}", line) for line in self._lines[self._looked_at :])

        wait_for(f"{name} {value}", stored)


@contextmanager
def mavproxy(master: str, folder: Path) -> Iterator[Terminal]:
    """MAVProxy on a vehicle, or on a port to which a swarm speaks."""
    program = Path(sys.executable).parent / "mavproxy.py"
    process = subprocess.Popen(
        [str(program), f"--master={master}", f"--state-basedir={folder}", f"--default-modules={MODULES}"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        cwd=folder,
        text=True,
        bufsize=1,
    )
    try:
        yield Terminal(process)
    finally:
        process.kill()
        process.wait(timeout=10.0)


def plan(folder: Path, name: str, items: list[tuple[int, int, float, float, float, float]]) -> Path:
    """A file of mission items: (frame, command, param1, latitude, longitude, altitude)."""
    lines = [
        f"{seq}\t{int(seq == 0)}\t{frame}\t{command}\t{param}\t0\t0\t0\t{latitude:.7f}\t{longitude:.7f}\t{altitude}\t1"
        for seq, (frame, command, param, latitude, longitude, altitude) in enumerate(items)
    ]
    path = folder / name
    path.write_text("\n".join(["QGC WPL 110", *lines, ""]))
    return path


def fly(terminal: Terminal, folder: Path) -> None:
    """Every step, in the order of a day out."""
    north = HOME[0] + 15.0 / 111_319.49
    mission = plan(
        folder,
        "mission.txt",
        [
            (0, WAYPOINT, 0, *HOME), (3, TAKEOFF, 0, 0, 0, 8.0), (3, WAYPOINT, 0, north, HOME[1], 10.0),
            (3, RETURN, 0, 0, 0, 0),
        ],
    )  # fmt: skip
    side = 0.001
    corners = [(side, side), (side, -side), (-side, -side), (-side, side)]
    fence = plan(folder, "fence.txt", [(0, POLYGON_INSIDE, 4, HOME[0] + dx, HOME[1] + dy, 0.0) for dx, dy in corners])
    rally = plan(folder, "rally.txt", [(3, RALLY, 0, HOME[0] + 0.0002, HOME[1], 20.0)])
    ask = terminal.ask
    for name, line, patterns in (
        ("arm refusal", "arm throttle", ("COMPONENT_ARM_DISARM: FAILED", "AP: Arm: .*")),
        ("parameters", "param fetch", (r"Received \d+ parameters",)),
        ("bad command", "long 31999 0 0 0 0 0 0 0", (r"COMMAND_ACK {command : 31999, result : 3",)),
        ("mission up", f"wp load {mission}", ("Sent all 4 waypoints", "TYPE_MISSION: ACCEPTED")),
        ("mission down", "wp list", ("Requesting 4 waypoints", r"Saved 4 waypoints")),
        ("fence up", f"fence load {fence}", ("TYPE_FENCE: ACCEPTED",)),
        ("fence down", "fence list", ("Requesting 4 fence items",)),
        ("rally up", f"rally load {rally}", ("TYPE_RALLY: ACCEPTED",)),
        ("rally down", "rally list", ("Requesting 1 rally items",)),
        ("log list", "log list", ("No logs|numLogs|Log 0",)),
    ):
        step(name, lambda line=line, patterns=patterns: ask(line, *patterns))
    step("parameter set", lambda: terminal.set_parameter("RTL_ALT", 1200.0))
    step("ready", lambda: terminal.printed("EKF3 IMU0 is using GPS"))
    for name, line, patterns in (
        ("guided", "mode guided", ("Mode GUIDED",)),
        ("arm", "arm throttle", ("COMPONENT_ARM_DISARM: ACCEPTED", "ARMED")),
        ("takeoff", "takeoff 10", ("NAV_TAKEOFF: ACCEPTED",)),
        ("mission flown", "mode auto", ("Mode AUTO", "AP: Reached command #2")),
        ("return", "mode rtl", ("Mode RTL", "DISARMED")),
    ):
        step(name, lambda line=line, patterns=patterns: ask(line, *patterns, timeout_s=90.0))


def main(url: str) -> None:
    with TemporaryDirectory() as name:
        folder = Path(name)
        with mavproxy(url, folder) as terminal:
            step("discovery", lambda: terminal.printed("online system 1"))
            fly(terminal, folder)


if __name__ == "__main__":
    expect(len(sys.argv) == 2, "one argument: the vehicle's address")
    main(sys.argv[1])
