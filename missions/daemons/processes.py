"""Which processes a launch runs, as a value and as a table: the world, the agents, the recorder."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from comms.credentials import agents_name
from comms.keys import RECORDER, WORLD
from missions.mission import Mission

if TYPE_CHECKING:
    from rich.table import Table

COMMAND = (sys.executable, "-m", "missions.cli")


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessPlan:
    """One process: its name, the words of its `swarm` command, and how often it is started again when it fails.

    On a secured network it is known by its `identity`.

    The mission is over when a `vital` one ends.
    """

    name: str
    identity: str
    words: tuple[str, ...]
    restarts: int = 0
    vital: bool = False

    @property
    def command(self) -> tuple[str, ...]:
        """The program and its arguments."""
        return (*COMMAND, *self.words)


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessOptions:
    """How a mission is run in many processes.

    Attributes:
        mission_words: the mission and what changes it, as on the command line. speed: as given to --speed, if it was.
        tlog: the folder of the agents' telemetry logs. began_unix_s: when their mission clock is 0, if it is started;
        one for all, and for those that are started again. views: --view, --web: how people look on.
        per_process: agents in one process. restarts: of an agent that fails. keys: the folder of all credentials, if
        the network is secured. insecure: whether that is left out on purpose.
    """

    mission_words: tuple[str, ...]
    endpoint: str
    speed: str | None = None
    report: str | None = None
    record: Path | None = None
    tlog: Path | None = None
    began_unix_s: float | None = None
    views: tuple[str, ...] = ()
    per_process: int = 1
    restarts: int = 3
    log_level: str = "warning"
    keys: Path | None = None
    insecure: bool = False


def plan_processes(mission: Mission, options: ProcessOptions) -> tuple[ProcessPlan, ...]:
    """The processes of a mission, in the order in which they start."""
    secured = () if options.keys is None else ("--keys", str(options.keys))
    common = ("--log-level", options.log_level, *secured)
    insecure = ("--insecure",) if options.insecure else ()
    speed = () if options.speed is None else ("--speed", options.speed)
    report = () if options.report is None else ("--report", options.report)
    connect = (*options.mission_words, "--connect", options.endpoint, *speed, *common)
    logged = () if options.tlog is None else ("--tlog", str(options.tlog))
    began_s = options.began_unix_s
    timed = () if options.tlog is None or began_s is None else ("--tlog-began", f"{began_s:.6f}")
    unsecured = insecure if mission.radio.endpoints else ()
    kept = () if options.record is None else ("--record", str(options.record))
    recorder = (*kept, *options.views)
    recorded = ("--recorded",) if recorder else ()
    plans = [
        ProcessPlan(
            name="world",
            identity=WORLD,
            words=(
                "world",
                *options.mission_words,
                "--listen",
                options.endpoint,
                *speed,
                *report,
                *recorded,
                *common,
                *insecure,
                "--leash",
            ),
            vital=True,
        )
    ]
    for first in range(0, mission.agents.count, options.per_process):
        last = min(first + options.per_process, mission.agents.count) - 1
        uids = str(first) if first == last else f"{first}-{last}"
        name = f"agent {uids}" if first == last else f"agents {uids}"
        identity, words = (
            agents_name((first, last)),
            ("agent", *connect, *logged, *timed, *unsecured, "--leash", "--id", uids),
        )
        plans.append(ProcessPlan(name=name, identity=identity, words=words, restarts=options.restarts))
    if recorder:
        words = ("record", *connect, *recorder)
        plans.append(ProcessPlan(name="recorder", identity=RECORDER, words=words))
    return tuple(plans)


def process_table(plans: Sequence[ProcessPlan]) -> Table:
    """The processes as a person reads them."""
    from rich.table import Table

    table = Table(title="Processes", title_justify="left", title_style="bold", box=None, pad_edge=False)
    table.add_column("name")
    table.add_column("restarts", justify="right")
    table.add_column("command", overflow="fold")
    for plan in plans:
        table.add_row(plan.name, str(plan.restarts), " ".join(("swarm", *plan.words)))
    return table
