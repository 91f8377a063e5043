"""`make bench-processes`: how fast daemons fly in lockstep beside one process, and what one of them weighs.

    python -m tests.benchmarks.processes [--agents 1 5 10 20] [--duration S]

Ticks a second count the whole flight, from power-on to landed, without the start of the processes.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from rich.console import Console
from rich.table import Table

from tests.missions.daemons.swarm import children, free_endpoint, resident_mb, swarm

TICK_S = 0.1  # of quickstart
RUNS = 3
BARE = ("quickstart", "--set", "agents.count=1", "--log-level", "info")


def ticks_a_second(n_agents: int, duration_s: float, *words: str) -> float:
    """Of one flight of quickstart."""
    with TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        mission = ("quickstart", "--set", f"agents.count={n_agents}", "--duration", f"{duration_s}")
        with swarm("launch", *mission, "--report", str(report), *words) as run:
            if run.wait() != 0:
                raise SystemExit(run.output)
        factor: float = json.loads(report.read_text())["timing"]["realtime_factor"]
        return factor / TICK_S


def ready_s() -> float:
    """From the start of an agent's process until it says hello to a world that waits for it."""
    endpoint = free_endpoint()
    with swarm("world", *BARE, "--duration", "1", "--listen", endpoint) as world:
        world.wait_for("listens on")
        began_s = perf_counter()
        with swarm("agent", *BARE, "--duration", "1", "--id", "0", "--connect", endpoint) as agent:
            agent.wait_for("ready")
            took_s = perf_counter() - began_s
            agent.wait()
    return took_s


def weights_mb(n_agents: int) -> dict[str, float]:
    """Resident memory of the processes of a mission under way, by the verb of each: the median where there are many."""
    found: dict[str, list[float]] = {}
    words = ("quickstart", "--set", f"agents.count={n_agents}", "--speed", "5", "--log-level", "info")
    with swarm("launch", *words, "--processes", "--listen", free_endpoint()) as run:
        run.wait_for("the mission begins")
        for pid, command in children(run.process.pid).items():
            found.setdefault(command.split()[3], []).append(resident_mb(pid))
    return {verb: median(sizes) for verb, sizes in found.items()}


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="How fast daemons fly, and what they weigh.")
    parser.add_argument("--agents", type=int, nargs="+", default=[1, 5, 10, 20])
    parser.add_argument("--duration", type=float, default=60.0)
    options = parser.parse_args(arguments)
    console = Console()
    console.print(f"quickstart, {options.duration:g} s; Python {platform.python_version()}, {os.cpu_count()} cores")
    table = Table("agents", "one process, ticks/s", "a daemon each, ticks/s", "times real time", box=None)
    for n_agents in options.agents:
        one = ticks_a_second(n_agents, options.duration)
        many = ticks_a_second(n_agents, options.duration, "--processes", "--listen", free_endpoint())
        table.add_row(f"{n_agents}", f"{one:.0f}", f"{many:.0f}", f"{many * TICK_S:.0f}")
    console.print(table)
    console.print(f"an agent's process is ready in {median(ready_s() for _ in range(RUNS)):.2f} s")
    for verb, size_mb in weights_mb(10).items():
        console.print(f"{verb}: {size_mb:.0f} MB resident")


if __name__ == "__main__":
    main()
