"""What a recording costs: `python -m tests.benchmarks.recording_cost [AGENTS] [MINUTES]`, as many targets as agents."""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

from missions.recording import Recorder
from tests.missions.toy_observations import toy_observations, toy_scene


def main(count: int = 10, minutes: int = 5) -> None:
    """Print milliseconds of processor time a tick, and megabytes a minute, at 10 Hz."""
    scene = toy_scene(n_agents=count, n_targets=count)
    ticks = minutes * 60 * scene.ticks_per_s
    observations = list(toy_observations(scene, ticks=ticks))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cost.rrd"
        start_s = time.process_time()
        with Recorder(path, scene=scene) as recorder:
            for observation in observations:
                recorder.observe(observation)
        spent_s = time.process_time() - start_s
        size = path.stat().st_size
    print(f"{count} + {count}: {1e3 * spent_s / ticks:.2f} ms a tick, {size / 1e6 / minutes:.2f} MB a minute")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
