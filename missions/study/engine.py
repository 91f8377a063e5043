"""Thousands of missions at once: ideal vehicles, ideal radio, and the same rules as in the air, compiled.

runs = fly_many(load_mission("quickstart"), seeds=range(1, 101))
runs.coverage.mean(), runs.coverage_late, runs.events
kept = trace(load_mission("narrow"), seed=1)     # one mission with everything kept
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
import numpy.typing as npt

from comms.chance import PLACE_TARGET
from missions import compose
from missions.mission import Mission, TrackTargets
from missions.study.compiled.loop import fly, new_oracle
from missions.study.compiled.state import (
    EVASIVE,
    RANDOM,
    REPLAY,
    STATIC,
    Kept,
    Setup,
    new_flock,
    new_kept,
    new_said,
    new_tables,
)
from missions.targets import herd
from swarm_agent.bcmommt.belief import cell_columns, cell_rows
from swarm_agent.bcmommt.net import Net
from swarm_agent.bcmommt.params import Answering, Params, Predictor, with_range
from vehicle_sim.placement import heading

_MOTIONS = {"evasive": EVASIVE, "random": RANDOM, "static": STATIC}
Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Runs:
    """What came of R runs of T ticks.

    Attributes:
        seeds (R): of each run. seen (R, T): targets seen by at least one agent. present (R, T): targets in the world.
        events (R, 3): target losses, discoveries, tag switches (definition 7).
        help (R, 6): `missions.metrics.HelpCount` of each. n_agents, n_targets: of each run.
    """

    seeds: Ints
    seen: npt.NDArray[np.int32]
    present: npt.NDArray[np.int32]
    events: Ints
    help: Ints
    n_agents: int
    n_targets: int

    @property
    def coverage(self) -> Floats:
        """A/n of each run, eq. 1 over n: (R)."""
        return _share(self.seen, self.present)

    @property
    def coverage_late(self) -> Floats:
        """The same over the last quarter of the ticks: (R)."""
        start = self.seen.shape[1] * 3 // 4
        return _share(self.seen[:, start:], self.present[:, start:])

    @property
    def utilization(self) -> Floats:
        """Coverage times targets per agent: (R)."""
        return self.coverage * self.n_targets / self.n_agents


@dataclass(frozen=True)
class Trace:
    """Everything of one run of T ticks, m agents, n targets: places in ENU meters, and who senses and tags whom.

    agents (T, m, 2), targets (T, n, 2), tagged and sensed (T, m, n) by the names that agents have for targets,
    mode (T, m) as `Mode` values, seen, present (T).
    """

    agents: Floats
    targets: Floats
    tagged: Flags
    sensed: Flags
    mode: npt.NDArray[np.int8]
    seen: npt.NDArray[np.int32]
    present: npt.NDArray[np.int32]
    events: Ints
    help: Ints


def fly_many(mission: Mission, *, seeds: Sequence[int], threads: int | None = None) -> Runs:
    """Fly `mission` once for every seed, on all cores (or `threads` of them). Memory is that of the results."""
    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        kept = list(pool.map(partial(_run, mission, start_tick=0, keep_all=False), seeds))
    n_targets = _herd_size(mission)
    return Runs(
        seeds=np.array(seeds, dtype=np.int64),
        seen=np.array([run.seen for run in kept]),
        present=np.array([run.present for run in kept]),
        events=np.array([run.events for run in kept]),
        help=np.array([run.help for run in kept]),
        n_agents=mission.agents.count,
        n_targets=n_targets,
    )


def trace(mission: Mission, *, seed: int, start_tick: int = 0) -> Trace:
    """Fly one mission and keep everything.

    Args:
        start_tick: the clock's tick at which the mission begins; a flight's clock has been running since power-on.
    """
    kept = _run(mission, seed, start_tick=start_tick, keep_all=True)
    return Trace(
        agents=kept.agents,
        targets=kept.targets,
        tagged=kept.tagged,
        sensed=kept.sensed,
        mode=kept.mode,
        seen=kept.seen,
        present=kept.present,
        events=kept.events,
        help=kept.help,
    )


def _run(mission: Mission, seed: int, *, start_tick: int, keep_all: bool) -> Kept:
    mission = mission.model_copy(update={"seed": seed})
    return fly_setup(setup_of(mission, start_tick=start_tick), compose.params(mission), keep_all=keep_all)


def fly_setup(setup: Setup, params: Params, *, keep_all: bool) -> Kept:
    """Fly from a start of one's own making, such as `setup_of(mission)._replace(target_x=...)`.

    Args:
        params: of all agents, but for the sensing range: the start has each one's own.
        keep_all: whether to fill all of what is kept, or the counts alone.
    """
    params = _with_arrays(params)
    m, n = len(setup.home_x), len(setup.target_x)
    kept = new_kept(setup.ticks, m, n, keep_all)
    tables = new_tables(m, n, _cells(setup, params))
    knowing = params.predictor == Predictor.PERFECT or params.answering == Answering.OPTIMAL
    oracle = new_oracle(m, n) if knowing else None
    fly(setup, params, tables, new_flock(setup), new_said(m, n), new_said(m, n), kept, oracle)
    return kept


def setup_of(mission: Mission, *, start_tick: int = 0) -> Setup:
    """What a mission starts from: its own seed, places and headings, and its targets' tracks if they have any."""
    targets, seed = mission.targets, mission.seed
    ticks = max(1, round(mission.duration_s / mission.tick_s))
    homes = np.array(compose.deployment(mission))
    headings = np.array(compose.headings(mission))
    targets_now = herd(mission)
    places = np.array([(0.0, 0.0) if place is None else place for place in targets_now.places])
    target_headings = np.array([heading(who=j, seed=seed, purpose=PLACE_TARGET) for j in range(len(places))])
    tracks = np.zeros((0, len(places), 2))
    speed, motion = 0.0, REPLAY
    if isinstance(targets, TrackTargets):
        tracks = np.full((ticks, len(places), 2), np.nan)
        for tick in range(ticks):
            for j, place in enumerate(targets_now.places):
                if place is not None:
                    tracks[tick, j] = place
            targets_now.advance(tick, (), ())
    else:
        speed, motion = targets.speed_m_s, _MOTIONS[targets.motion]
    return Setup(
        home_x=homes[:, 0].copy(),
        home_y=homes[:, 1].copy(),
        heading_x=headings[:, 0].copy(),
        heading_y=headings[:, 1].copy(),
        target_x=places[:, 0].copy(),
        target_y=places[:, 1].copy(),
        target_ux=target_headings[:, 0].copy(),
        target_uy=target_headings[:, 1].copy(),
        track_x=tracks[:, :, 0].copy(),
        track_y=tracks[:, :, 1].copy(),
        motion=motion,
        target_speed_m_s=speed,
        notice_range_m=mission.target_sensing_range_m,
        comm_range_m=mission.radio.range_m,
        sensing_range_m=np.array(mission.agents.sensing_ranges_m),
        cos_half_opening=compose.cos_half_opening(mission),
        identity_error=mission.agents.sensing.identity_error,
        seed=seed,
        ticks=ticks,
        start_tick=start_tick,
    )


def _herd_size(mission: Mission) -> int:
    return len(herd(mission).places)


def _with_arrays(params: Params) -> Params:
    """The nets' weights as arrays, whose type does not tell how many they are."""
    pair, triple = params.pair_net, params.triple_net
    return params._replace(
        pair_net=Net(np.array(pair.hidden), pair.bias), triple_net=Net(np.array(triple.hidden), triple.bias)
    )


def _cells(setup: Setup, params: Params) -> int:
    """Cells of the agent that has most of them: the one that sees least far."""
    nearest = with_range(params, setup.sensing_range_m.min())
    return cell_columns(nearest) * cell_rows(nearest)


def _share(seen: npt.NDArray[np.int32], present: npt.NDArray[np.int32]) -> Floats:
    total = present.sum(axis=1)
    share: Floats = np.divide(seen.sum(axis=1), total, out=np.full(len(seen), np.nan), where=total > 0)
    return share
