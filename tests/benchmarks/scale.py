"""`make bench-scale`: what an agent costs in a small swarm and in a large one, at the same density.

    python -m tests.benchmarks.scale [--agents 10 30 100 300 1000] [--ticks N] [--plot F.png]

The arena grows with the swarm; ranges stay. Vehicles are ideal and all runs in one process. The processor time of the
mission's ticks is counted, without takeoff: how busy the computer is otherwise matters little.

The last row is what memory alone does: as many agents as in the largest swarm, in swarms of 30 that fly in turns.
"""

from __future__ import annotations

import argparse
import os
import platform
import resource
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from math import sqrt
from multiprocessing import get_context
from pathlib import Path
from statistics import fmean

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
SMALL_SWARM = 30
TICK_S = 0.1  # of quickstart
SETTLING_TICKS = 10  # until everybody has heard its neighbors


class Turn:
    """Of one of several flights in a ring, in threads of their own, of which one runs at a time."""

    def __init__(self, before: Turn | None = None) -> None:
        self.before = before or self
        self.after = self.before.after if before else self
        self.before.after = self.after.before = self
        self._mine = threading.Semaphore(0)

    def end(self) -> None:
        """It is the next one's."""
        self.after._mine.release()

    def take(self) -> None:
        """Wait until it is this one's."""
        self._mine.acquire()

    def leave(self) -> None:
        """End for good."""
        self.before.after, self.after.before = self.after, self.before
        self.end()


@dataclass(slots=True)
class Cost:
    """What a flight of `n_agents` took: an observer that counts.

    Attributes:
        ticks_s: processor time of each tick of the mission. neighbors: frames heard, per agent and tick.
        peak_mb: most memory resident. turn: where flights take turns.
    """

    n_agents: int
    ticks: int
    ticks_s: list[float] = field(default_factory=list)
    neighbors: float = 0.0
    peak_mb: float = 0.0
    turn: Turn | None = None
    _last_s: float = 0.0
    _heard: int = 0

    def observe(self, observation: Observation) -> None:
        """Count a tick, if it is one of the mission, and let others have theirs."""
        now_s = time.process_time()
        tick = observation.mission_tick
        if tick is not None and tick > SETTLING_TICKS:
            self.ticks_s.append(now_s - self._last_s)
            self._heard += sum(len(status.mates) for status in observation.statuses)
            self.neighbors = self._heard / len(self.ticks_s) / self.n_agents
            if len(self.ticks_s) >= self.ticks:
                raise _EnoughError
        if self.turn is not None:
            self.turn.end()
            self.turn.take()
        self._last_s = time.process_time()

    @property
    def agent_tick_us(self) -> float:
        """Processor time per agent and tick, in microseconds: the mean."""
        return sum(self.ticks_s) / len(self.ticks_s) / self.n_agents * 1e6


def fly(found: Cost, *, seed: int = 1) -> None:
    """Fly that many agents over as many targets, for so many ticks of the mission."""
    radius_m = RADIUS_M * sqrt(found.n_agents / AGENTS_THERE)
    changes = {
        "seed": seed,
        "agents.count": found.n_agents,
        "targets.count": found.n_agents,
        "arena.radius_m": radius_m,
        "agents.deployment.radius_m": radius_m / 2,
        "targets.deployment.radius_m": radius_m / 2,
        "agents.altitude.base_m": 2,
        "agents.altitude.layers": 1,
        "vehicle.kind": "ideal",
        "vehicle.boot_s": 0.1,
    }
    mission = load_mission("quickstart", overrides=[Override(f"{key}={value}") for key, value in changes.items()])
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        with suppress(_EnoughError):
            flight.run(pace=Lockstep(), observers=[found], stop=lambda: False)


def alone(measure: Callable[[int, int], Cost], count: int, ticks: int) -> Cost:
    """Measure in a process of its own, whose memory nobody has used before."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(measure, count, ticks).result()


def peak_mb() -> float:
    """The most memory that this process has had resident so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def cost(n_agents: int, ticks: int) -> Cost:
    """What one swarm takes."""
    found = Cost(n_agents, ticks)
    fly(found)
    found.peak_mb = peak_mb()
    return found


def cost_in_turns(n_swarms: int, ticks: int) -> Cost:
    """What small swarms take that fly in turns, tick by tick."""
    turns = [Turn()]
    while len(turns) < n_swarms:
        turns.append(Turn(turns[-1]))
    costs = [Cost(SMALL_SWARM, ticks, turn=turn) for turn in turns]

    def take_part(number: int) -> None:
        turns[number].take()
        fly(costs[number], seed=number + 1)
        turns[number].leave()

    threads = [threading.Thread(target=take_part, args=(number,)) for number in range(n_swarms)]
    for thread in threads:
        thread.start()
    turns[-1].end()
    for thread in threads:
        thread.join()
    ticks_s = [tick_s for each in costs for tick_s in each.ticks_s]
    heard = fmean(each.neighbors for each in costs)
    return Cost(SMALL_SWARM, ticks, ticks_s=ticks_s, neighbors=heard, peak_mb=peak_mb())


class _EnoughError(Exception):
    """All that was to be measured has been: nobody need land."""


def plot(costs: Sequence[Cost], file: Path) -> None:
    """The curve above what the agents hear, as a picture."""
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(2, 1, sharex=True, figsize=(6.4, 4.8), layout="constrained")
    counts = [each.n_agents for each in costs]
    panels[0].plot(counts, [each.agent_tick_us for each in costs], "o-", color="#2a78d6")
    panels[0].set(ylabel="microseconds per\nagent and tick")
    panels[1].plot(counts, [each.neighbors for each in costs], "o-", color="#2a78d6")
    panels[1].set(
        xscale="log", xlabel="agents, and as many targets, at one density", ylabel="frames heard per\nagent and tick"
    )
    for panel in panels:
        panel.set_ylim(bottom=0.0)
        panel.grid(alpha=0.3)
    figure.savefig(file, dpi=150)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="What an agent costs in a small swarm and in a large one.")
    parser.add_argument("--agents", type=int, nargs="+", default=[10, 30, 100, 300, 1000])
    parser.add_argument("--ticks", type=int, default=50)
    parser.add_argument("--plot", type=Path, metavar="FILE")
    options = parser.parse_args(arguments)
    console = Console()
    console.print(f"ideal vehicles, one process; Python {platform.python_version()}, {os.cpu_count()} cores")
    heads = ("agents", "us per agent-tick", "frames heard", "us per frame", "times real time", "MB at most")
    table = Table(*heads, box=None)

    def add(name: str, found: Cost, n_agents: int) -> None:
        tick_s = found.agent_tick_us * n_agents / 1e6
        per_frame_us = found.agent_tick_us / found.neighbors
        cells = (found.agent_tick_us, found.neighbors, per_frame_us, TICK_S / tick_s, found.peak_mb)
        table.add_row(name, *(f"{cell:.{digits}f}" for cell, digits in zip(cells, (0, 1, 1, 1, 0), strict=True)))

    costs = [alone(cost, n_agents, options.ticks) for n_agents in options.agents]
    for found in costs:
        add(f"{found.n_agents}", found, found.n_agents)
    n_swarms = max(options.agents) // SMALL_SWARM
    if n_swarms > 1:
        add(f"{n_swarms} times {SMALL_SWARM}", alone(cost_in_turns, n_swarms, options.ticks), n_swarms * SMALL_SWARM)
    console.print(table)
    if options.plot is not None:
        plot(costs, options.plot)


if __name__ == "__main__":
    main()
