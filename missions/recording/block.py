"""A run of consecutive observations as arrays: K ticks, N agents, M targets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from comms.status import Activity
from missions.observation import PLACES_PER_M, Observation
from missions.recording.palette import ACTIVITY_INKS
from missions.recording.scene import Scene

Floats = npt.NDArray[np.float32]
Ints = npt.NDArray[np.int64]
Colors = npt.NDArray[np.uint32]
Mask = npt.NDArray[np.bool_]

# Bodies are drawn at every tick; what hangs on them this often. At 10 Hz nobody sees the difference, but the disk does.
LINE_STEP_S = 0.2


def stored(values: npt.ArrayLike) -> Floats:
    """`values` as they are stored: 32-bit floats rounded to 1/64. Nobody sees less, and it halves the file."""
    return (np.round(np.asarray(values, dtype=np.float64) * PLACES_PER_M) / PLACES_PER_M).astype(np.float32)


@dataclass(frozen=True)
class Block:
    """Observations in the order they were made, and what the views need of them, computed once on demand."""

    scene: Scene
    observations: Sequence[Observation]

    def every(self, seconds: float) -> Block:
        """The ticks of this block that fall on a multiple of `seconds`: the same ticks however a run is cut up."""
        stride = max(1, round(seconds * self.scene.ticks_per_s))
        return Block(self.scene, [seen for seen in self.observations if seen.tick % stride == 0])

    def __len__(self) -> int:
        return len(self.observations)

    @cached_property
    def ticks(self) -> Ints:
        """(K,)"""
        return np.array([seen.tick for seen in self.observations], dtype=np.int64)

    @cached_property
    def times_ns(self) -> Ints:
        """(K,) mission time in whole nanoseconds, so that 0.1 * 3 and 0.3 are one moment."""
        return np.array([round(seen.time_s * 1e9) for seen in self.observations], dtype=np.int64)

    @cached_property
    def activities(self) -> list[list[Activity]]:
        """K lists of N."""
        return [[status.activity for status in seen.statuses] for seen in self.observations]

    @cached_property
    def colors(self) -> Colors:
        """(K, N): each agent in the color of what it does."""
        rows = [[ACTIVITY_INKS[activity] for activity in row] for row in self.activities]
        return np.array(rows, dtype=np.uint32).reshape(len(self), self.scene.n_agents)

    @cached_property
    def positions_m(self) -> Floats:
        """(K, N, 3) ENU, true."""
        rows = [[truth.position_m for truth in seen.truths] for seen in self.observations]
        return stored(rows).reshape(len(self), self.scene.n_agents, 3)

    @cached_property
    def headings_rad(self) -> Floats:
        """(K, N) clockwise from north, true."""
        rows = [[truth.heading_rad for truth in seen.truths] for seen in self.observations]
        return np.array(rows, dtype=np.float32).reshape(len(self), self.scene.n_agents)

    @cached_property
    def speeds_m_s(self) -> Floats:
        """(K, N) over the ground, true."""
        rows = [[truth.velocity_m_s[:2] for truth in seen.truths] for seen in self.observations]
        return stored(np.linalg.norm(np.array(rows).reshape(len(self), self.scene.n_agents, 2), axis=2))

    @cached_property
    def batteries(self) -> Floats:
        """(K, N) remaining share; nan where unknown."""
        rows = [[np.nan if s.battery is None else s.battery for s in seen.statuses] for seen in self.observations]
        return np.array(rows, dtype=np.float32).reshape(len(self), self.scene.n_agents)

    @cached_property
    def targets_m(self) -> Floats:
        """(K, M, 3) ENU, true, on the ground."""
        rows = [[(target.x_m, target.y_m, 0.0) for target in seen.targets] for seen in self.observations]
        return stored(rows).reshape(len(self), self.scene.n_targets, 3)

    @cached_property
    def present(self) -> Mask:
        """(K, M): is the target in the world?"""
        return self._of_targets([[target.present for target in seen.targets] for seen in self.observations])

    @cached_property
    def seen(self) -> Mask:
        """(K, M): is it within somebody's sensing range?"""
        return self._of_targets([[target.seen for target in seen.targets] for seen in self.observations])

    @cached_property
    def tagged(self) -> Mask:
        """(K, M): does somebody own it?"""
        owned = np.zeros((len(self), self.scene.n_targets), dtype=np.bool_)
        for row, seen in enumerate(self.observations):
            for status in seen.statuses:
                owned[row, list(status.tags)] = True
        return owned

    @cached_property
    def called(self) -> Mask:
        """(K, M): does somebody call for help with it?"""
        wanted = np.zeros((len(self), self.scene.n_targets), dtype=np.bool_)
        for row, seen in enumerate(self.observations):
            for status in seen.statuses:
                wanted[row, [call.target for call in status.calls]] = True
        return wanted

    def _of_targets(self, rows: list[Any]) -> Mask:
        return np.array(rows, dtype=np.bool_).reshape(len(self), self.scene.n_targets)
