"""`swarm` commands as processes of a test: started, read, signalled, and none left behind."""

from __future__ import annotations

import os
import queue
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from time import monotonic

from tests.patience import PATIENCE_S, until

COMMAND = (sys.executable, "-m", "missions.cli")
ROOT = Path(__file__).parents[3]

FOR_EVER_S = 4000.0  # of a mission that a test ends
SMALL = ("--set", "agents.count=3", "--set", "targets.count=4", "--set", "vehicle.boot_s=0.5")


class Swarm:
    """One command that runs, `within` another that gives it its place, and what it says on standard error."""

    def __init__(self, *words: str, within: tuple[str, ...] = ()) -> None:
        self.process = subprocess.Popen(
            (*within, *COMMAND, *words), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, cwd=ROOT
        )
        self.said: list[str] = []
        self._lines: queue.Queue[str | None] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def wait_for(self, text: str) -> None:
        """Until it has said so."""
        deadline_s = monotonic() + PATIENCE_S
        while not any(text in line for line in self.said):
            try:
                line = self._lines.get(timeout=max(0.0, deadline_s - monotonic()))
            except queue.Empty:
                line = None
            assert line is not None, f"never said {text!r}, but:\n{''.join(self.said)}"
            self.said.append(line)

    def wait(self) -> int:
        """Until it has ended; its exit code."""
        code = self.process.wait(PATIENCE_S)
        while (line := self._lines.get(timeout=PATIENCE_S)) is not None:
            self.said.append(line)
        return code

    @property
    def output(self) -> str:
        """All that it has said and that was waited for."""
        return "".join(self.said)

    def _read(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self._lines.put(line)
        self._lines.put(None)


@contextmanager
def swarm(*words: str, within: tuple[str, ...] = ()) -> Iterator[Swarm]:
    """A command and its children, none of which outlives the block."""
    running = Swarm(*words, within=within)
    try:
        yield running
    finally:
        family = [*children(running.process.pid), running.process.pid]
        for pid in family:
            kill(pid, signal.SIGKILL)
        running.process.wait(PATIENCE_S)


def kill(pid: int, number: int) -> None:
    """Send a signal to whoever is still there."""
    with suppress(ProcessLookupError):
        os.kill(pid, number)


def children(parent: int) -> dict[int, str]:
    """The processes that `parent` has started: their words by their ids."""
    found = {}
    for folder in Path("/proc").iterdir():
        try:
            if folder.name.isdigit() and int(_status(folder)["PPid"]) == parent:
                found[int(folder.name)] = (folder / "cmdline").read_text().replace("\0", " ")
        except (FileNotFoundError, ProcessLookupError):
            continue
    return found


def resident_mb(pid: int) -> float:
    """How much memory it holds now."""
    return int(_status(Path("/proc") / str(pid))["VmRSS"].split()[0]) / 1024


def runs(pid: int) -> bool:
    """Whether there is such a process, and it has not ended."""
    try:
        return not _status(Path("/proc") / str(pid))["State"].startswith(("Z", "X"))
    except (FileNotFoundError, ProcessLookupError):
        return False


def wait_until_gone(pids: Iterator[int] | list[int]) -> None:
    """Until none of them runs."""
    family = [*pids]
    until(lambda: not any(runs(pid) for pid in family))


def free_endpoint() -> str:
    """Where nobody listens, and no test of another process will: this one keeps the UDP port of the same number."""
    for port in _PORTS:
        mark = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        with suppress(OSError), socket.create_server(("127.0.0.1", port)):
            mark.bind(("127.0.0.1", port))
            _MARKS.append(mark)
            return f"tcp/127.0.0.1:{port}"
        mark.close()
    raise AssertionError("no port is free")


# Below those that the system gives away itself: to who listens at any port, and to whoever calls somebody.
_PORTS = iter(range(20_000, 32_000))
_MARKS: list[socket.socket] = []


def _status(folder: Path) -> dict[str, str]:
    lines = (folder / "status").read_text().splitlines()
    return {key: value.strip() for key, _, value in (line.partition(":") for line in lines)}
