"""`make bench-recording`: what a recording costs beside the mission it is of.

    python -m tests.benchmarks.recording [--duration S]

A mission is flown without and with a recorder, in one process and as fast as it goes. What the processor spends more is
the recorder's, its threads and the agents' answers to it included; `of a tick` holds it against a tick in real time.
Bytes are of two recordings, the other one a third as long: what every recording has (names, styles, views, the index),
and what each minute of mission adds; as written (what a killed run leaves), and optimized.
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


def _split(less: int, more: int, short_min: float, long_min: float) -> tuple[str, str]:
    """What does not grow with time and what a minute adds, in MB, from the bytes of two recordings."""
    a_minute = (more - less) / (long_min - short_min)
    return f"{(more - a_minute * long_min) / 1e6:.2f}", f"{a_minute / 1e6:.2f}"


def main() -> None:
    parser = argparse.ArgumentParser(description="What a recording costs.")
    parser.add_argument("--duration", type=float, default=120.0, help="seconds of mission")
    options = parser.parse_args()
    heads = ("agents + targets", "ms a tick", "of a tick", "MB written", "and a minute", "MB optimized", "and a minute")
    table = Table(*heads, box=None)
    with TemporaryDirectory() as folder:
        for name, changes in SIZES.items():
            mission, short = (
                load_mission("quickstart", overrides=[Override(text) for text in (*changes, f"duration_s={span_s:g}")])
                for span_s in (options.duration, options.duration / 3)
            )
            path = Path(folder) / "bench.rrd"
            bare, recorded, less = fly(mission, None), fly(mission, path), fly(short, path)
            more_s = (recorded.spent_s - bare.spent_s) / recorded.ticks
            table.add_row(
                name,
                f"{1e3 * more_s:.2f}",
                f"{more_s / mission.tick_s:.1%}",
                *_split(less.written, recorded.written, less.minutes, recorded.minutes),
                *_split(less.kept, recorded.kept, less.minutes, recorded.minutes),
            )
    Console().print(table)


if __name__ == "__main__":
    main()
