"""`make bench-recording`: what a recording costs beside the mission it is of.

    python -m tests.benchmarks.recording [--duration S]

A mission is flown without and with a recorder, in one process and as fast as it goes. What the processor spends more is
the recorder's, its threads and the agents' answers to it included; `of a tick` holds it against a tick in real time.
Bytes are of mission time: as written (what a killed run leaves), and optimized.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from rich.console import Console
from rich.table import Table

from comms.clock import Lockstep
from comms.session import open_local_bus
from missions.flight import Flight
from missions.launch import explain_every_s, recorder_of
from missions.load import load_mission
from missions.mission import Mission
from missions.observation import Observer
from missions.options import LaunchOptions
from missions.overrides import Override

SIZES = {
    "10 + 10": (),
    "100 + 100": (
        "agents.count=100",
        "targets.count=100",
        "arena.radius_m=95",
        "agents.deployment.radius_m=60",
        "targets.deployment.radius_m=90",
    ),
}


class Cost(NamedTuple):
    """One flight: processor seconds, ticks, minutes of mission, and bytes as written and as kept."""

    spent_s: float
    ticks: int
    minutes: float
    written: int = 0
    kept: int = 0


def fly(mission: Mission, path: Path | None) -> Cost:
    """Fly it, recorded or not."""
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        observers: list[Observer] = []
        began_s = time.process_time()
        written = 0
        if path is None:
            flight.run(pace=Lockstep(), observers=observers, stop=lambda: False)
        else:
            flight.side.explain_every_s = explain_every_s(mission)
            options = LaunchOptions(record=path)
            with recorder_of(mission, len(flight.world.places), options) as recorder:
                flight.run(pace=Lockstep(), observers=[recorder], stop=lambda: False)
            written = recorder.written_bytes
        spent_s = time.process_time() - began_s
        kept = 0 if path is None else path.stat().st_size
        return Cost(spent_s, flight.side.tick, flight.clock_s / 60, written, kept)


def main() -> None:
    parser = argparse.ArgumentParser(description="What a recording costs.")
    parser.add_argument("--duration", type=float, default=60.0, help="seconds of mission")
    options = parser.parse_args()
    table = Table("agents + targets", "ms a tick", "of a tick", "MB/min written", "MB/min optimized", box=None)
    with TemporaryDirectory() as folder:
        for name, changes in SIZES.items():
            texts = (*changes, f"duration_s={options.duration:g}")
            mission = load_mission("quickstart", overrides=[Override(text) for text in texts])
            bare, recorded = fly(mission, None), fly(mission, Path(folder) / "bench.rrd")
            more_s = (recorded.spent_s - bare.spent_s) / recorded.ticks
            table.add_row(
                name,
                f"{1e3 * more_s:.2f}",
                f"{more_s / mission.tick_s:.1%}",
                f"{recorded.written / 1e6 / recorded.minutes:.2f}",
                f"{recorded.kept / 1e6 / recorded.minutes:.2f}",
            )
    Console().print(table)


if __name__ == "__main__":
    main()
