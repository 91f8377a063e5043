"""`make bench-scale`: what an agent costs in a small swarm and in a large one, at the same density.

    python -m tests.benchmarks.scale [--agents 10 30 100 300 1000] [--ticks N] [--plot F.png]

The arena grows with the swarm; ranges stay. Vehicles are ideal and all runs in one process. The processor time of the
mission's ticks is counted, without takeoff: how busy the computer is otherwise matters little.
"""

from __future__ import annotations

import argparse
import os
import platform
import resource
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from math import sqrt
from pathlib import Path

from rich.console import Console
from rich.table import Table

from comms.clock import Lockstep
from comms.session import open_local_bus
from missions.flight import Flight
from missions.load import load_mission
from missions.observation import Observation
from missions.overrides import Override

RADIUS_M = 30.0  # of the arena of ten agents, of which they start in the inner half, as their targets do
AGENTS_THERE = 10
SETTLING_TICKS = 10  # until everybody has heard its neighbors


@dataclass(slots=True)
class Cost:
    """What a flight of `n_agents` took: an observer that counts.

    Attributes:
        ticks_s: processor time of each tick of the mission. neighbors: frames heard, per agent and tick.
    """

    n_agents: int
    ticks: int
    ticks_s: list[float] = field(default_factory=list)
    neighbors: float = 0.0
    _last_s: float = 0.0
    _heard: int = 0

    def observe(self, observation: Observation) -> None:
        """Count a tick, if it is one of the mission."""
        now_s = time.process_time()
        tick = observation.mission_tick
        if tick is not None and tick > SETTLING_TICKS:
            self.ticks_s.append(now_s - self._last_s)
            self._heard += sum(len(status.mates) for status in observation.statuses)
            self.neighbors = self._heard / len(self.ticks_s) / self.n_agents
            if len(self.ticks_s) >= self.ticks:
                raise _EnoughError
        self._last_s = time.process_time()

    @property
    def agent_tick_us(self) -> float:
        """Processor time per agent and tick, in microseconds: the mean."""
        return sum(self.ticks_s) / len(self.ticks_s) / self.n_agents * 1e6


def cost(n_agents: int, ticks: int) -> Cost:
    """Fly that many agents over as many targets, for so many ticks of the mission."""
    radius_m = RADIUS_M * sqrt(n_agents / AGENTS_THERE)
    changes = {
        "agents.count": n_agents,
        "targets.count": n_agents,
        "arena.radius_m": radius_m,
        "agents.deployment.radius_m": radius_m / 2,
        "targets.deployment.radius_m": radius_m / 2,
        "agents.altitude.base_m": 2,
        "agents.altitude.layers": 1,
        "vehicle.kind": "ideal",
        "vehicle.boot_s": 0.1,
    }
    mission = load_mission("quickstart", overrides=[Override(f"{key}={value}") for key, value in changes.items()])
    found = Cost(n_agents, ticks)
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        with suppress(_EnoughError):
            flight.run(pace=Lockstep(), observers=[found], stop=lambda: False)
    return found


class _EnoughError(Exception):
    """All that was to be measured has been: nobody need land."""


def plot(costs: Sequence[Cost], file: Path) -> None:
    """The curve, as a picture."""
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6.4, 3.6), layout="constrained")
    axes.plot([each.n_agents for each in costs], [each.agent_tick_us for each in costs], "o-", color="#2a78d6")
    axes.set(xscale="log", xlabel="agents, and as many targets", ylabel="microseconds per agent and tick")
    axes.set_ylim(bottom=0.0)
    axes.grid(alpha=0.3)
    figure.savefig(file, dpi=150)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="What an agent costs in a small swarm and in a large one.")
    parser.add_argument("--agents", type=int, nargs="+", default=[10, 30, 100, 300, 1000])
    parser.add_argument("--ticks", type=int, default=50)
    parser.add_argument("--plot", type=Path, metavar="FILE")
    options = parser.parse_args(arguments)
    console = Console()
    console.print(f"ideal vehicles, one process; Python {platform.python_version()}, {os.cpu_count()} cores")
    table = Table("agents", "us per agent-tick", "times real time", "frames heard", "MB resident at most", box=None)
    costs = []
    for n_agents in options.agents:
        found = cost(n_agents, options.ticks)
        costs.append(found)
        tick_s = found.agent_tick_us * n_agents / 1e6
        peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        table.add_row(
            f"{n_agents}",
            f"{found.agent_tick_us:.0f}",
            f"{0.1 / tick_s:.1f}",
            f"{found.neighbors:.1f}",
            f"{peak_mb:.0f}",
        )
    console.print(table)
    if options.plot is not None:
        plot(costs, options.plot)


if __name__ == "__main__":
    main()
