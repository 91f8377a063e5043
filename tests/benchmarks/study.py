"""How fast the compiled study is: environment steps (one tick of a whole mission) per core-second, after compiling.

    python -m tests.benchmarks.study [--runs N] [--missions NAME]...

Seconds are of processor time on one thread. Compiling is timed apart; it is done once and cached.
"""

from __future__ import annotations

import argparse
import time
from statistics import median

from rich.console import Console
from rich.table import Table

from missions.load import load_mission
from missions.overrides import Override

SEEDS = range(1, 41)


def main() -> None:
    parser = argparse.ArgumentParser(description="Environment steps per core-second of the compiled study.")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--mission", action="append", default=[])
    options = parser.parse_args()
    console = Console()
    began_s = time.perf_counter()
    from missions.study.engine import fly_many

    fly_many(load_mission("narrow", overrides=[Override("duration_s=1")]), seeds=[1], threads=1)
    console.print(f"import and compile (or load from the cache): {time.perf_counter() - began_s:.1f} s")
    table = Table("mission", "agents v targets", "steps per core-second", "least", "most", "us a step", box=None)
    for name in options.mission or ["quickstart", "narrow", "crowded"]:
        mission = load_mission(name)
        rates = []
        for _ in range(options.runs + 1):
            began_s = time.process_time()
            runs = fly_many(mission, seeds=SEEDS, threads=1)
            rates.append(runs.seen.size / (time.process_time() - began_s))
        counted = rates[1:]
        rate = median(counted)
        who = f"{runs.n_agents} v {runs.n_targets}"
        table.add_row(name, who, f"{rate:,.0f}", f"{min(counted):,.0f}", f"{max(counted):,.0f}", f"{1e6 / rate:.2f}")
    console.print(table)


if __name__ == "__main__":
    main()
