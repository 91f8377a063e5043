"""Where everybody was, now and then: enough for smooth lines through all of a mission, however long it was."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from comms.status import Activity
from missions.observation import Observation

# As many at least, once there are so many ticks, and less than twice as many: finer than a screen.
POINTS = 600

Floats = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]


@dataclass(slots=True)
class Snapshot:
    """One tick, and what happened from then to the next one.

    Attributes:
        time_s: mission clock. on_duty: in MISSION. activities: of agents, by uid.
        agents_m: (N, 2) east and north. targets_m: (M, 2), nan where there is none.
        unseen: (M,) whether nobody saw the target at some tick from this one to before the next one.
    """

    time_s: float
    on_duty: bool
    activities: tuple[Activity, ...]
    agents_m: Floats
    targets_m: Floats
    unseen: Mask


class Snapshots:
    """An observer that keeps every tick, then every second one, every fourth ..."""

    def __init__(self) -> None:
        self._kept: list[Snapshot] = []
        self._ticks, self._stride = 0, 1
        self._last: Observation | None = None

    def observe(self, seen: Observation) -> None:
        """Note one tick."""
        if self._ticks % self._stride == 0:
            self._kept.append(_snapshot(seen))
            if len(self._kept) == 2 * POINTS:
                self._halve()
        else:
            self._kept[-1].unseen |= _unseen(seen)
        self._ticks += 1
        self._last = seen

    @property
    def taken(self) -> Sequence[Snapshot]:
        """In order of time; the last tick is among them."""
        last = self._last
        if last is None or self._kept[-1].time_s == last.time_s:
            return self._kept
        return [*self._kept, _snapshot(last)]

    def _halve(self) -> None:
        for one, other in zip(self._kept[::2], self._kept[1::2], strict=True):
            one.unseen |= other.unseen
        self._kept = self._kept[::2]
        self._stride *= 2


def _snapshot(seen: Observation) -> Snapshot:
    targets = [(one.x_m, one.y_m) if one.present else (np.nan, np.nan) for one in seen.targets]
    return Snapshot(
        time_s=seen.time_s,
        on_duty=seen.mission_tick is not None,
        activities=tuple(status.activity for status in seen.statuses),
        agents_m=np.array([truth.position_m[:2] for truth in seen.truths]).reshape(-1, 2),
        targets_m=np.array(targets).reshape(-1, 2),
        unseen=_unseen(seen),
    )


def _unseen(seen: Observation) -> Mask:
    return np.array([not target.seen for target in seen.targets], dtype=np.bool_)
