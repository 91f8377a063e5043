"""The peers' table: environment steps per core-second, medians over several runs after a warm-up."""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from importlib.metadata import version
from importlib.util import find_spec
from statistics import median

import torch
from vmas import make_env

from tests.benchmarks.peers import cmommt, cmommt_scenario

STUDY = "tests.benchmarks.study"
AGENTS = TARGETS = 10
WARM_UP_S, RUN_S = 0.5, 1.0
Advance = Callable[[], object]


def bare(batch: int) -> Advance:
    """The torch operations with nothing around them."""
    state = cmommt.start(AGENTS, TARGETS, batch)

    def advance() -> None:
        nonlocal state
        state = cmommt.step(state)

    return advance


def scenario(batch: int) -> Advance:
    """The same as a VMAS scenario."""
    env = make_env(cmommt_scenario.Scenario(), num_envs=batch, seed=1, n_agents=AGENTS, n_targets=TARGETS)
    return lambda: env.step([])


def discovery(batch: int, **counts: int) -> Advance:
    """VMAS's own task, with random actions drawn beforehand: what is timed is VMAS."""
    env = make_env("discovery", num_envs=batch, seed=1, **counts)
    actions = env.get_random_actions()
    return lambda: env.step(actions)


def crowded_discovery(batch: int) -> Advance:
    """Discovery with as many agents and targets as ours, in an area with room for them."""
    return discovery(batch, n_agents=AGENTS, n_targets=TARGETS, x_semidim=2, y_semidim=2)


PEERS: dict[str, Callable[[int], Advance]] = {
    "CMOMMT as a VMAS scenario, 10 v 10": scenario,
    "the same torch operations without VMAS": bare,
    "VMAS discovery as it comes, 5 v 7": discovery,
    "VMAS discovery, 10 v 10": crowded_discovery,
}


def steps_per_second(batch: int, runs: int) -> dict[str, list[float]]:
    """Environment steps a core-second of every peer in each of `runs` rounds; all peers take turns in a round."""
    peers = {name: build(batch) for name, build in PEERS.items()}
    for advance in peers.values():
        _calls_within(advance, WARM_UP_S)
    found: dict[str, list[float]] = {name: [] for name in peers}
    for _ in range(runs):
        for name, advance in peers.items():
            calls, seconds = _calls_within(advance, RUN_S)
            found[name].append(batch * calls / seconds)
    return found


def _calls_within(advance: Advance, span_s: float) -> tuple[int, float]:
    """Call until `span_s` has been spent, twice at least; how often, and in how many seconds.

    Seconds of processor time, of all threads: what others do on this machine is not ours.
    """
    calls, began_s, spent_s = 0, time.process_time(), 0.0
    while spent_s < span_s or calls < 2:
        advance()
        calls += 1
        spent_s = time.process_time() - began_s
    return calls, spent_s


def scenario_coverage(batch: int = 64, duration_s: float = 240.0) -> tuple[float, float]:
    """Coverage of `batch` missions in the VMAS scenario: over all their time, and over the last quarter of it."""
    env = make_env(cmommt_scenario.Scenario(), num_envs=batch, seed=1, n_agents=AGENTS, n_targets=TARGETS)
    seen = []
    for _ in range(round(duration_s / cmommt.TICK_S)):
        seen.append(env.scenario.coverage().mean().item())
        env.step([])
    late = seen[len(seen) * 3 // 4 :]
    return sum(seen) / len(seen), sum(late) / len(late)


def run_study(python: str) -> int:
    """Our side, in the project's own environment, as it prints itself."""
    if find_spec(STUDY) is None:
        print(f"our study: {STUDY} is not there")
        return 0
    print(f"our study (python -m {STUDY} --quick):", flush=True)
    return subprocess.run([python, "-m", STUDY, "--quick"], check=False).returncode


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description="VMAS beside our compiled study: environment steps per core-second.")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--batches", type=int, nargs="+", default=[1, 64, 1024, 4096])
    parser.add_argument("--study", metavar="PYTHON", help="the interpreter that has our study; without it: peers only")
    options = parser.parse_args(arguments)
    torch.set_num_threads(1)
    print(
        f"Python {platform.python_version()}, torch {torch.__version__}, vmas {version('vmas')}, 1 thread of "
        f"{os.cpu_count()} cores; {options.runs} runs of {RUN_S:g} s after a warm-up"
    )
    print("environment steps per core-second: median (least to most)")
    with torch.inference_mode():
        for batch in options.batches:
            print(f"\nmissions at once: {batch:,}")
            for name, found in steps_per_second(batch, options.runs).items():
                print(f"  {name:<40}{median(found):>10,.0f}  ({min(found):,.0f} to {max(found):,.0f})", flush=True)
        whole, late = scenario_coverage()
    print(
        f"\ncoverage in the VMAS scenario, 64 missions of 240 s from 15 m: {whole:.3f}, in the last minute {late:.3f}"
    )
    return run_study(options.study) if options.study else 0


if __name__ == "__main__":
    sys.exit(main())
