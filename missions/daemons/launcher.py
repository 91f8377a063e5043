"""`swarm launch --processes`: starts the processes of a plan, watches them, and leaves none behind.

The world and the agents hold the other end of a pipe on their standard input: when this process ends, however it does,
they notice, land and go (`--leash`). The recorder goes with the world.
"""

from __future__ import annotations

import errno
import signal
import socket
import subprocess
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from time import monotonic, sleep

from rich.console import Console

from comms.endpoint import place_of
from comms.keys import RECORDER
from missions.daemons.options import ENDPOINTS
from missions.daemons.processes import ProcessPlan
from missions.ending import Ending
from missions.exit_codes import BAD_INPUT, DONE, FAILED, STOPPED
from missions.problems import InputError
from missions.sides.phases import RETURN_LIMIT_S

LOOK_EVERY_S = 0.1
# From the end of the world until its agents have landed by themselves: they notice, wait for it a while, and fly home.
LANDING_S = RETURN_LIMIT_S + 60.0
SAY_EVERY_S = 30.0
ENDINGS = frozenset((signal.SIGTERM, signal.SIGINT))
GOING_S = 3.0  # from a request to end until that is forced
OCCUPIED = "; another mission may listen there, as every launch with --speed does: --listen names another port"


class _Child:
    """One process of the plan, and how often it may still be started again."""

    def __init__(self, plan: ProcessPlan) -> None:
        self.plan = plan
        self.restarts_left = plan.restarts
        self.given_up = False
        self._told: set[int] = set()
        self._process = self._started()

    @property
    def code(self) -> int | None:
        """Its exit code; None while it runs."""
        return self._process.poll()

    def restart(self) -> None:
        """Start it again."""
        self.restarts_left -= 1
        self._close()
        self._process = self._started()

    def give_up(self, *, because: str = "") -> str:
        """Let it be, and say so."""
        self.given_up = True
        return f"{self.plan.name} ended with code {self.code}: not started again{because}"

    def signal(self, number: int) -> None:
        """Send it a signal, if it still runs."""
        self._told.add(number)
        with suppress(ProcessLookupError):
            self._process.send_signal(number)

    def hurry(self) -> None:
        """End it at once; a vital one has a report to write first. Two signals of a kind would be one."""
        for number in ENDINGS - self._told if self.plan.vital else (signal.SIGKILL,):
            self.signal(number)

    def ask(self) -> None:
        """End, please, unless it has been told."""
        if signal.SIGTERM not in self._told:
            self.signal(signal.SIGTERM)

    def end(self, deadline_s: float) -> None:
        """See that it ends, who was asked to: by force, if it still runs at that time."""
        try:
            self._process.wait(max(0.0, deadline_s - monotonic()))
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._close()

    def _started(self) -> subprocess.Popen[bytes]:
        # A session of its own: Ctrl-C at the terminal is ours to pass on.
        return subprocess.Popen(self.plan.command, stdin=subprocess.PIPE, start_new_session=True)

    def _close(self) -> None:
        if self._process.stdin is not None:
            self._process.stdin.close()


class _ReportFile:
    """Where the world writes its report, if that is a file, and whether it is there."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._before = self._mark()

    def missing(self, code: int) -> str | None:
        """What is to be said of a world that ended with that code, if it has left no report; None if there is no need.

        A report that is there may be an earlier run's: this one's would be another file, as it is written whole.
        """
        after = self._mark()
        silent = code >= 0 and (self._path is None or code in (DONE, BAD_INPUT))
        if silent or after != self._before:
            return None
        said = f"world ended with code {code}: there is no report"
        return said if after is None else f"{said}, and {self._path} is of an earlier run"

    def _mark(self) -> tuple[int, int] | None:
        try:
            found = None if self._path is None else self._path.stat()
        except OSError:
            return None
        return None if found is None else (found.st_ino, found.st_mtime_ns)


def run_processes(
    plans: Sequence[ProcessPlan],
    *,
    endpoint: str,
    console: Console,
    prepare: Callable[[], None] = lambda: None,
    report: Path | None = None,
) -> int:
    """Run a plan until its world ends. Returns the world's exit code: it knows whom it has lost, and who may be lost.

    Args:
        prepare: what is done before the first process starts, and only if they can meet.
        report: the file to which the world writes its report.

    Raises:
        InputError: another process listens at the endpoint.
    """
    _check_free(endpoint)
    prepare()
    ending = Ending(lambda text: console.print(f"Stopping: {text}.", markup=False))
    children: list[_Child] = []
    report_file = _ReportFile(report)
    with ending.listening():
        try:
            children.extend(_Child(plan) for plan in plans)
            return _watch(children, ending, console, report_file)
        except KeyboardInterrupt:
            for child in children:
                child.hurry()
            return STOPPED if ending.interrupted else FAILED
        finally:
            _end(children)


def _watch(children: Sequence[_Child], ending: Ending, console: Console, report_file: _ReportFile) -> int:
    vital = [child for child in children if child.plan.vital]
    passed_on = False
    while all(child.code is None for child in vital):
        if ending.asked and not passed_on:
            passed_on = True
            for child in vital:
                child.signal(signal.SIGINT if ending.interrupted else signal.SIGTERM)
        for child in children:
            if child.plan.identity == RECORDER and child.code == BAD_INPUT:
                return BAD_INPUT  # it has said why, and the world would wait for it in vain
            _tend(child, ending, console)
        sleep(LOOK_EVERY_S)
    codes = [child.code for child in vital if child.code is not None]
    for missing in filter(None, map(report_file.missing, codes)):
        console.print(missing, markup=False, soft_wrap=True)
    code = max(map(_exit_code, codes), default=FAILED)
    _await_landing(children, console)
    return code


def _tend(child: _Child, ending: Ending, console: Console) -> None:
    """Start it again if it has failed, or say once that it is not."""
    code = child.code
    if code in (None, DONE) or child.plan.vital or child.given_up:
        return
    if code != BAD_INPUT and child.restarts_left and not ending.asked:
        console.print(f"{child.plan.name} ended with code {code}: started again", markup=False)
        child.restart()
        return
    is_used_up = child.plan.identity != RECORDER and code != BAD_INPUT and not child.restarts_left
    because = f" (--restarts {child.plan.restarts})" if is_used_up else ""
    console.print(child.give_up(because=because), markup=False)


def _end(children: Sequence[_Child]) -> None:
    """See that all end. They have one time to go, however many they are."""
    for child in children:
        child.ask()
    deadline_s = monotonic() + GOING_S
    for child in children:
        child.end(deadline_s)


def _await_landing(children: Sequence[_Child], console: Console) -> None:
    """Wait for those who outlive the world, and say for whom."""
    now_s = monotonic()
    deadline_s, say_at_s = now_s + LANDING_S, now_s + SAY_EVERY_S
    while (running := [child.plan.name for child in children if child.code is None]) and now_s < deadline_s:
        if now_s >= say_at_s:
            say_at_s += SAY_EVERY_S
            console.print(f"the world has ended; still under way: {', '.join(running)}", markup=False)
        sleep(LOOK_EVERY_S)
        now_s = monotonic()


def _exit_code(code: int) -> int:
    """A process that a signal ended has failed."""
    return code if code >= 0 else FAILED


def _check_free(endpoint: str) -> None:
    """Agents must not find another mission's world where ours cannot listen."""
    found = place_of(endpoint)
    if found is None:
        raise InputError(f"--listen: got {endpoint}; allowed: {ENDPOINTS}")
    try:
        [(family, _, _, _, place), *_] = socket.getaddrinfo(*found, type=socket.SOCK_STREAM)
        with socket.create_server(place, family=family):
            pass
    except (OSError, OverflowError, UnicodeError) as error:
        is_taken = isinstance(error, OSError) and error.errno == errno.EADDRINUSE
        hint = OCCUPIED if is_taken else ""
        raise InputError(f"--listen: got {endpoint}; allowed: a free port of this machine ({error}){hint}") from error
