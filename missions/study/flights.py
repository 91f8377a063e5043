"""Runs of a point whose mission has faults: what is compiled has none, so each is flown in process, on every core.

They are flown as they would be by `swarm launch`, and counted by the same metrics.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import astuple
from functools import partial
from math import nan
from multiprocessing import get_context
from os import cpu_count
from typing import NamedTuple

import numpy as np

from comms.clock import Lockstep
from comms.session import open_local_bus
from missions.faults.costs import Costs
from missions.flight import Flight
from missions.metrics import Metrics
from missions.mission import Mission
from missions.study.flown import Flown, second_starts


class Run(NamedTuple):
    """One flight: targets seen and present by tick, COUNTS, coverage of the last quarter, and who noticed what."""

    seen: list[int]
    present: list[int]
    counts: list[int]
    late: float
    noticed_s: list[float]
    n_targets: int


def fly_flights(mission: Mission, seeds: Sequence[int], threads: int | None = None) -> Flown:
    """Fly `mission` once for every seed, with all its wires and faults."""
    workers = min(threads or cpu_count() or 1, len(seeds))
    one = partial(fly_one, mission)
    if workers == 1:
        runs = list(map(one, seeds))
    else:
        # Never forked: zenoh has threads.
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            runs = list(pool.map(one, seeds))
    return _flown(mission, seeds, runs)


def fly_one(mission: Mission, seed: int) -> Run:
    """One flight of the mission with that seed, up to the end of its observation."""
    own = mission.model_copy(update={"seed": seed})
    metrics = Metrics(costs=Costs(own.faults, tick_s=own.tick_s))
    with open_local_bus() as bus:
        flight = Flight(own, bus)
        flight.run(pace=Lockstep(), observers=[metrics], stop=lambda: False)
    noticed = [told["noticed_after_s"] for told in metrics.costs.told(metrics.coverage)]
    seen, present = metrics.coverage.by_tick
    late = metrics.coverage.late
    return Run(
        seen=seen,
        present=present,
        counts=[*astuple(metrics.events), *astuple(metrics.help)],
        late=nan if late is None else late,
        noticed_s=[nan if after_s is None else after_s for after_s in noticed],
        n_targets=len(flight.world.places),
    )


def _flown(mission: Mission, seeds: Sequence[int], runs: Sequence[Run]) -> Flown:
    ticks = max(1, round(mission.duration_s / mission.tick_s))
    starts = second_starts(ticks, mission.tick_s)

    def by_second(rows: list[list[int]]) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
        # A swarm of which nobody is left comes home early: then nothing more is seen, though it is there.
        whole = np.array([row + [0] * (ticks - len(row)) for row in rows], dtype=np.int64)
        return np.add.reduceat(whole, starts, axis=1)

    present = [run.present + [run.present[-1]] * (ticks - len(run.present)) for run in runs]
    return Flown(
        seeds=np.array(seeds, dtype=np.int64),
        seen=by_second([run.seen for run in runs]),
        present=by_second(present),
        counts=np.array([run.counts for run in runs], dtype=np.int64),
        late=np.array([run.late for run in runs]),
        n_agents=mission.agents.count,
        n_targets=runs[0].n_targets,
        noticed_s=np.array([run.noticed_s for run in runs]),
    )
