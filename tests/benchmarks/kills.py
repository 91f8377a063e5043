"""`make bench-kills`: what it costs when a process of a mission is killed or frozen, whichever it is.

    python -m tests.benchmarks.kills [--only NAME ...]

Quickstart flies in real processes, five times as fast as time, and is recorded; after a third of it something happens
to one of them. Coverage is counted from the recording: in the half minute before, in the one from then on, and in the
next. Noticed is on the wall clock, by whoever says so first.
"""

from __future__ import annotations

import argparse
import json
import re
import signal
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep
from typing import Any

from rich.console import Console
from rich.table import Table

from missions.metrics import Metrics
from missions.recording.playback import play_back
from tests.missions.daemons.swarm import Swarm, children, free_endpoint, kill, swarm, wait_until_gone

DURATION_S, AT_S, WINDOW_S, TICK_S = 120.0, 40.0, 30.0, 0.1
SPEED = 5.0
WIDE = 160
FROZEN_S = 6.0  # on the wall clock
_TIME = re.compile(r"time_s=([0-9.]+)")

Whom = Callable[[Swarm], int]


def process(*words: str) -> Whom:
    """The child whose command has these words."""

    def find(run: Swarm) -> int:
        [pid] = [pid for pid, command in children(run.process.pid).items() if set(words) <= set(command.split())]
        return pid

    return find


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """Something that happens: to whom, by which signal (None: nothing), and how it is told that it was noticed.

    per_process: agents in one process. thaws: the process is let go on. speed: of the mission's clock.
    """

    name: str
    whom: Whom
    sign: str
    signal: int = signal.SIGKILL
    per_process: int = 1
    thaws: bool = False
    speed: float | None = SPEED


CASES = (
    Case(name="kill an agent", whom=process("agent", "3"), sign="level=error who=agent-3"),
    Case(name="kill a worker of five", whom=process("agent", "5-9"), sign="level=error who=agent-5", per_process=5),
    Case(
        name="freeze an agent",
        whom=process("agent", "3"),
        sign="level=error who=agent-3",
        signal=signal.SIGSTOP,
        thaws=True,
    ),
    Case(
        name="freeze an agent, lockstep",
        whom=process("agent", "3"),
        sign="level=error who=agent-3",
        signal=signal.SIGSTOP,
        thaws=True,
        speed=None,
    ),
    Case(name="kill the recorder", whom=process("record"), sign="the recorder has gone"),
    Case(name="kill the world", whom=process("world"), sign="the world has gone"),
    Case(name="kill the launcher", whom=lambda run: run.process.pid, sign="asked to end"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What came of a case. Coverage is None where nothing was recorded."""

    noticed_s: float
    coverage: tuple[float | None, ...]
    code: int
    flown_s: float | None
    recorded: str


def happen(case: Case, folder: Path) -> Outcome:
    """Fly, let it happen, and look at what is left."""
    report, recording = folder / "report.json", folder / "q.rrd"
    words = ("launch", "quickstart", "--duration", f"{DURATION_S}", "--log-level", "info")
    pace = () if case.speed is None else ("--speed", f"{case.speed}")
    files = ("--report", str(report), "--record", str(recording))
    many = ("--processes", f"{case.per_process}", "--listen", free_endpoint())
    with swarm(*words, *pace, *files, *many) as run:
        run.wait_for("the mission begins")
        began_s, family = monotonic(), list(children(run.process.pid))
        victim = case.whom(run)
        sleep(0.0 if case.speed is None else AT_S / case.speed)
        struck_s = monotonic()
        kill(victim, case.signal)
        run.wait_for(case.sign)
        noticed_s = monotonic() - struck_s
        if case.thaws:
            sleep(max(0.0, FROZEN_S - noticed_s))
            kill(victim, signal.SIGCONT)
        code = run.wait()
        wait_until_gone(family)
    beginning_s = _clock_of("the mission begins", run.said)
    at_s = _clock_of(case.sign, run.said) - beginning_s if case.speed is None else (struck_s - began_s) * case.speed
    return Outcome(
        noticed_s=noticed_s,
        code=code,
        flown_s=json.loads(report.read_text())["duration_s"] if report.exists() else None,
        **_recorded(recording, at_s=at_s, struck_s=beginning_s + at_s),
    )


def _recorded(recording: Path, *, at_s: float, struck_s: float) -> dict[str, Any]:
    """What the recording still tells: coverage around `at_s` of MISSION, and what is lost, `struck_s` on the clock."""
    whole = recording.is_file()
    metrics, last_s = Metrics(), 0.0
    with play_back(recording if whole else recording.with_name(recording.name + ".part")) as playback:
        for observation in playback.observations():
            metrics.observe(observation)
            last_s = observation.time_s
    edges = [round((at_s + window * WINDOW_S) / TICK_S) for window in (-1, 0, 1, 2)]
    return {
        "coverage": tuple(metrics.coverage.between(*edge) for edge in pairwise(edges)),
        "recorded": _lost(playback.ticks_missing, whole=whole, after_s=struck_s - last_s),
    }


def _lost(ticks: int, *, whole: bool, after_s: float) -> str:
    missing = f"{ticks} ticks missing" if ticks else "nothing"
    if whole:
        return missing
    return f"repaired; the last {after_s:.1f} s before it, and all after"


def _clock_of(text: str, said: Sequence[str]) -> float:
    line = next(line for line in said if text in line)
    match = _TIME.match(line)
    assert match is not None, line
    return float(match[1])


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="What it costs when a process of a mission is killed or frozen.")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="cases whose names have one of these in them")
    only = parser.parse_args(arguments).only
    console, progress = Console(width=None if sys.stdout.isatty() else WIDE), Console(stderr=True)
    table = Table("what", "noticed after", "before", "from then", "after", "code", "flown", "lost", box=None)
    for case in CASES:
        if only and not any(word in case.name for word in only):
            continue
        progress.print(f"{case.name} ...")
        with TemporaryDirectory() as folder:
            outcome = happen(case, Path(folder))
        table.add_row(
            case.name,
            f"{outcome.noticed_s:.2f} s",
            *("" if share is None else f"{share:.0%}" for share in outcome.coverage),
            f"{outcome.code}",
            "no report" if outcome.flown_s is None else f"{outcome.flown_s:.0f} s",
            outcome.recorded,
        )
    console.print(table)


if __name__ == "__main__":
    main()
