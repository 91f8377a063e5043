"""What is kept of the runs of one point: second by second what was seen, and what happened in each run.

flown = fly_point(mission, seeds=[1, 2, 3])
flown.share(from_s=60, until_s=120)  # (3,): coverage of each run in that minute
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from missions.metrics import EVENT_COUNTS, HELP_COUNTS
from missions.mission import Mission

if TYPE_CHECKING:
    from missions.study.engine import Runs

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

COUNTS = (*EVENT_COUNTS, *HELP_COUNTS)


@dataclass(frozen=True, slots=True)
class Flown:
    """R runs of one point, of S seconds each, in the order of their seeds.

    Attributes:
        seeds (R). seen, present (R, S): targets seen and present, summed over the ticks of each second.
        counts (R, 9): COUNTS of each run. late (R): coverage of the last quarter of the ticks.
        n_agents, n_targets: of every run.
        noticed_s (R, F): how long after each of the mission's faults somebody noticed it, NaN where nobody did; None
            for a mission without faults.
    """

    seeds: Ints
    seen: Ints
    present: Ints
    counts: Ints
    late: Floats
    n_agents: int
    n_targets: int
    noticed_s: Floats | None = None

    def share(self, *, from_s: float = 0.0, until_s: float | None = None) -> Floats:
        """Coverage of each run (R) in a window of whole seconds; NaN where no target was present."""
        window = slice(int(from_s), None if until_s is None else max(ceil(until_s), int(from_s) + 1))
        return _share(self.seen[:, window].sum(axis=1), self.present[:, window].sum(axis=1))

    def share_by_second(self) -> Floats:
        """Coverage of each run in each second: (R, S)."""
        return _share(self.seen, self.present)

    def of_seeds(self, seeds: Sequence[int]) -> Flown:
        """The runs of these seeds alone, in ascending order; seeds that were not flown are left out."""
        order = np.argsort(self.seeds, kind="stable")
        rows = order[np.isin(self.seeds[order], np.asarray(seeds, dtype=np.int64))]
        return self._rows(rows)

    def joined(self, others: Sequence[Flown]) -> Flown:
        """These runs and those of `others`, each seed once, in ascending order."""
        all_of = [self, *others]
        _, first = np.unique(np.concatenate([part.seeds for part in all_of]), return_index=True)
        whole = Flown(
            seeds=np.concatenate([part.seeds for part in all_of]),
            seen=np.concatenate([part.seen for part in all_of]),
            present=np.concatenate([part.present for part in all_of]),
            counts=np.concatenate([part.counts for part in all_of]),
            late=np.concatenate([part.late for part in all_of]),
            n_agents=self.n_agents,
            n_targets=self.n_targets,
            noticed_s=_stacked([part.noticed_s for part in all_of]),
        )
        return whole._rows(first)

    def _rows(self, rows: Ints) -> Flown:
        return Flown(
            self.seeds[rows], self.seen[rows], self.present[rows], self.counts[rows], self.late[rows],
            self.n_agents, self.n_targets, None if self.noticed_s is None else self.noticed_s[rows],
        )  # fmt: skip


FlyPoint = Callable[[Mission, Sequence[int]], Flown]
"""Flies one point once for every seed."""


def fly_point(mission: Mission, seeds: Sequence[int], threads: int | None = None) -> Flown:
    """Fly `mission` once for every seed: compiled, or in process where it has faults."""
    if mission.faults:
        from missions.study.flights import fly_flights

        return fly_flights(mission, seeds, threads)
    from missions.study.engine import fly_many

    return condensed(fly_many(mission, seeds=list(seeds), threads=threads), tick_s=mission.tick_s)


def condensed(runs: Runs, *, tick_s: float) -> Flown:
    """Tick by tick to second by second."""
    starts = second_starts(runs.seen.shape[1], tick_s)
    return Flown(
        seeds=runs.seeds.astype(np.int64),
        seen=np.add.reduceat(runs.seen, starts, axis=1).astype(np.int64),
        present=np.add.reduceat(runs.present, starts, axis=1).astype(np.int64),
        counts=np.hstack([runs.events, runs.help]).astype(np.int64),
        late=runs.coverage_late.astype(np.float64),
        n_agents=runs.n_agents,
        n_targets=runs.n_targets,
    )


def second_starts(ticks: int, tick_s: float) -> Ints:
    """The first tick of every second that has one: ticks belong to the second they fall into."""
    seconds = np.floor(np.arange(ticks) * tick_s + 1e-9)
    return np.flatnonzero(np.diff(seconds, prepend=-1.0)).astype(np.int64)


def _stacked(parts: Sequence[Floats | None]) -> Floats | None:
    known = [part for part in parts if part is not None]
    return np.concatenate(known) if known else None


def _share(seen: Ints, present: Ints) -> Floats:
    shares: Floats = np.divide(seen, present, out=np.full(seen.shape, np.nan), where=present > 0)
    return shares
