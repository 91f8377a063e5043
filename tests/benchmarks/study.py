"""How fast the compiled study is: environment steps (one tick of a whole mission) per core-second, after compiling.

    python -m tests.benchmarks.study [--runs N] [--mission NAME]... [--quick]

Seconds of steps are of processor time on one thread. Compiling is timed apart; it is done once and cached. Then, unless
`--quick`: the paper's 3,200 runs on all cores, how the cost grows with agents and targets, and memory with runs.
"""

from __future__ import annotations

import argparse
import resource
import time
from statistics import median

from rich.console import Console
from rich.table import Table

from missions.load import load_mission
from missions.mission import Mission
from missions.overrides import Override

SEEDS = range(1, 41)
SUITE = range(1, 3201)  # section 6: "Overall 3,200 simulations with a duration between 2 and 4 minutes were run"
SIZES = (5, 10, 20, 40)


def main() -> None:
    parser = argparse.ArgumentParser(description="Environment steps per core-second of the compiled study.")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--mission", action="append", default=[])
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    console = Console()
    began_s = time.perf_counter()
    from missions.study.engine import fly_many

    fly_many(load_mission("narrow", overrides=[Override("duration_s=1")]), seeds=[1], threads=1)
    console.print(f"import and compile (or load from the cache): {time.perf_counter() - began_s:.1f} s")
    missions = {name: load_mission(name) for name in options.mission or ["quickstart", "narrow", "crowded"]}
    console.print(_speeds(missions, runs=options.runs))
    if not options.quick:
        console.print(_suite(runs=options.runs))
        sizes = {f"{n} v {n}": _sized(n) for n in SIZES}
        console.print(_speeds(sizes, runs=options.runs))
        console.print(_memory())


def _speeds(missions: dict[str, Mission], *, runs: int) -> Table:
    from missions.study.engine import fly_many

    table = Table(
        "mission", "agents v targets", "steps per core-second", "least", "most", "us a step", "ns a pair", box=None
    )
    for name, mission in missions.items():
        rates = []
        for _ in range(runs + 1):
            began_s = time.process_time()
            flown = fly_many(mission, seeds=SEEDS, threads=1)
            rates.append(flown.seen.size / (time.process_time() - began_s))
        counted = rates[1:]
        rate, pairs = median(counted), flown.n_agents * flown.n_targets
        table.add_row(
            name,
            f"{flown.n_agents} v {flown.n_targets}",
            f"{rate:,.0f}",
            f"{min(counted):,.0f}",
            f"{max(counted):,.0f}",
            f"{1e6 / rate:.2f}",
            f"{1e9 / rate / pairs:.1f}",
        )
    return table


def _suite(*, runs: int) -> str:
    """As many runs as the paper's, of four minutes each, on all cores."""
    from missions.study.engine import fly_many

    walls_s = []
    for _ in range(runs):
        began_s = time.perf_counter()
        flown = fly_many(load_mission("narrow"), seeds=SUITE)
        walls_s.append(time.perf_counter() - began_s)
    size = " x ".join(f"{n:,}" for n in flown.seen.shape)
    return f"{size} ticks on all cores: {median(walls_s):.1f} s ({min(walls_s):.1f} to {max(walls_s):.1f} s)"


def _sized(n: int) -> Mission:
    """n agents over n targets at the density of quickstart."""
    radius_m = 30.0 * (n / 10) ** 0.5
    changes = (f"agents.count={n}", f"targets.count={n}", f"arena.radius_m={radius_m:.2f}")
    starts = (f"agents.deployment.radius_m={radius_m / 2:.2f}", f"targets.deployment.radius_m={radius_m / 2:.2f}")
    return load_mission("quickstart", overrides=[Override(change) for change in (*changes, *starts)])


def _memory() -> str:
    """What the process has held at most, before and after ten times as many runs."""
    from missions.study.engine import fly_many

    mission = load_mission("quickstart", overrides=[Override("duration_s=60")])
    peaks = []
    for count in (300, 3000):
        fly_many(mission, seeds=range(count))
        peaks.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
    return f"memory at most: {peaks[0]:.0f} MB after 300 runs, {peaks[1]:.0f} MB after 3,000"


if __name__ == "__main__":
    main()
