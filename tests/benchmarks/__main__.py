"""`make bench`: how fast a mission flies, and where the time goes. Medians over several runs after a warm-up.

    python -m tests.benchmarks [--runs N] [--mission NAME]

The real-time factor counts the whole flight, from power-on to landed, against the wall clock of one process.
"""

from __future__ import annotations

import argparse
import cProfile
import os
import platform
import pstats
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.table import Table

from comms.clock import Lockstep
from comms.session import open_local_bus
from missions.flight import Flight
from missions.launch import recorder_of
from missions.load import load_mission
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observer
from missions.options import LaunchOptions

# What a tick is made of: the functions that together are all of it, by file and name.
PARTS = {
    "sensing and targets": (("world.py", "sense"), ("world.py", "advance")),
    "radio in: zenoh callbacks' queue, decoding": (("radio.py", "drain"),),
    "agents: telemetry (MAVLink in)": (("pilot.py", "listen"),),
    "agents: hearing and seeing": (("agent.py", "_perceive"),),
    "agents: rules": (("step.py", "decide"),),
    "agents: setpoints (MAVLink out)": (("pilot.py", "act"),),
    "agents: frames and status": (("agent.py", "_say"), ("agent.py", "_tell")),
    "radio out: encoding, zenoh": (("radio.py", "send"), ("air.py", "carry")),
    "vehicles: flight, telemetry, commands": (("vehicle.py", "tick"),),
    "metrics and observation": (("world.py", "_observe"), ("metrics.py", "observe")),
}


def fly(mission: Mission, record: Path | None) -> tuple[float, Flight]:
    """Wall seconds of one flight, from its first tick until the recording is closed."""
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        observers: list[Observer] = [Metrics()]
        began_s = time.perf_counter()
        if record is None:
            flight.run(pace=Lockstep(), observers=observers, stop=lambda: False)
        else:
            with recorder_of(mission, len(flight.world.places), LaunchOptions(record=record)) as recorder:
                flight.run(pace=Lockstep(), observers=[*observers, recorder], stop=lambda: False)
        return time.perf_counter() - began_s, flight


def factors(mission: Mission, runs: int, record: Path | None) -> list[float]:
    """Real-time factors of `runs` flights after one that is not counted."""
    return [flight.clock_s / wall_s for wall_s, flight in [fly(mission, record) for _ in range(runs + 1)][1:]]


def shares(mission: Mission) -> tuple[dict[str, float], int]:
    """Seconds of each part of one flight under the profiler (which slows small functions more), and its ticks."""
    profiler = cProfile.Profile()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        profiler.runcall(flight.run, pace=Lockstep(), observers=[Metrics()], stop=lambda: False)
    seconds = dict.fromkeys((*PARTS, "everything"), 0.0)
    for (file, _, name), (_, _, _, cumulative, _) in pstats.Stats(profiler).stats.items():  # type: ignore[attr-defined]
        here = (os.path.basename(file), name)
        for part, members in PARTS.items():
            if here in members:
                seconds[part] += cumulative
        if here == ("flight.py", "run"):
            seconds["everything"] += cumulative
    return seconds, round(flight.clock_s / mission.tick_s)


def main() -> None:
    parser = argparse.ArgumentParser(description="How fast a mission flies in one process.")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--mission", default="quickstart")
    options = parser.parse_args()
    mission = load_mission(options.mission)
    console = Console()
    console.print(
        f"{mission.name}: {mission.agents.count} agents, {mission.duration_s:.0f} s, {options.runs} runs after a "
        f"warm-up; Python {platform.python_version()}, {os.cpu_count()} cores"
    )
    table = Table("real-time factor", "median", "least", "most", box=None)
    with TemporaryDirectory() as folder:
        for name, record in (("without recording", None), ("with recording", Path(folder) / "bench.rrd")):
            found = factors(mission, options.runs, record)
            table.add_row(name, *(f"{value:.1f}" for value in (median(found), min(found), max(found))))
    console.print(table)
    seconds, ticks = shares(mission)
    everything = seconds.pop("everything")
    seconds["the rest"] = everything - sum(seconds.values())
    table = Table("where a tick goes (under the profiler)", "share", "ms a tick", box=None)
    for part, spent in sorted(seconds.items(), key=lambda item: -item[1]):
        table.add_row(part, f"{spent / everything:.0%}", f"{1000 * spent / ticks:.2f}")
    console.print(table)


if __name__ == "__main__":
    main()
