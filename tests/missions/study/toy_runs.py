"""Runs that need no compiler: what a seed of a mission sees is drawn, and depends on nothing but the two."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from comms.chance import draw
from missions.mission import Mission, MovingTargets
from missions.study.flown import COUNTS, Flown


def fly(mission: Mission, seeds: Sequence[int]) -> Flown:
    """Of every target ten sights in each second; more agents and a better policy see more."""
    targets = mission.targets
    assert isinstance(targets, MovingTargets)
    seconds, n, m = int(mission.duration_s), targets.count, mission.agents.count
    share = m / (m + n) + 0.1 * (mission.policy.name == "b-cmommt")
    noise = np.array([[draw(seed, second, m, n) for second in range(seconds)] for seed in seeds])
    seen = np.floor(10 * n * np.clip(share + 0.2 * (noise - 0.5), 0, 1)).astype(np.int64)
    present = np.full_like(seen, 10 * n)
    late = seen[:, seconds * 3 // 4 :].sum(axis=1) / present[:, seconds * 3 // 4 :].sum(axis=1)
    counts = np.array([[seed % (kind + 2) for kind in range(len(COUNTS))] for seed in seeds], dtype=np.int64)
    return Flown(np.array(seeds, dtype=np.int64), seen, present, counts, late, m, n)


WITHOUT_FIGURES = """name: toy
mission: quickstart
set: {duration_s: 20}
sweep:
  - {agents.count: [5, 10], agents.deployment.radius_m: [10, 15]}
  - {targets.count: [10, 20]}
policies:
  basic: {name: b-cmommt-basic}
  default: {}
runs: 7
seed: 3
claims:
  - paper: The default covers more.
    figure: figure 1
    checks: [{of: {policy: default}, than: {policy: basic}}]
  - paper: Coverage is around 40 %.
    figure: figure 2
    checks: [{of: {agents.count: 10, targets.count: 20}, expect: about, value: 0.4, within: 0.1}]
"""
STUDY = (
    WITHOUT_FIGURES
    + """figures:
  - {name: over-time, title: Over time, paper: Coverage rises.}
  - {name: by-count, x: targets.count}
"""
)
