"""The targets in 3D: a body with its name, a ring that says whether it is held, and one more while help is called."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import rerun as rr

from comms.status import Activity
from missions.recording import palette
from missions.recording.block import LINE_STEP_S, Block, Mask
from missions.recording.columns import Rows, rings
from missions.recording.scene import Scene
from missions.recording.stage import Sizes


class Targets:
    """Draws the targets that are in the world: yellow ring when tagged, pale when only seen, red when out of sight."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._sizes = Sizes.of(scene)
        self._named: Mask | None = None

    def tell_anew(self) -> None:
        """Tell next what holds, whether it is new or not."""
        self._named = None

    def rows(self, block: Block) -> Iterator[Rows]:
        """Bodies at every tick, rings less often."""
        yield from self._bodies(block)
        yield from self._names(block)
        yield from self._rings(block.every(LINE_STEP_S))

    def _bodies(self, block: Block) -> Iterator[Rows]:
        present = block.present
        bodies = np.where(block.seen, palette.TARGET, palette.UNSEEN).astype(np.uint32)[present]
        columns = rr.Points3D.columns(positions=block.targets_m[present], colors=bodies)
        yield Rows("/world/targets/body", block, columns.partition(present.sum(axis=1)))

    def _rings(self, block: Block) -> Iterator[Rows]:
        present = block.present
        places, counts = block.targets_m[present], present.sum(axis=1)
        held = np.where(block.tagged, palette.TAGGED, palette.SEEN)
        colors = np.where(block.seen, held, palette.UNSEEN).astype(np.uint32)[present]
        yield Rows("/world/targets/tags", block, rings(places, self._sizes.tag_radius_m, colors, counts))

        called = present & block.called
        amber = np.full(called.sum(), palette.ACTIVITY_INKS[Activity.CALLING], dtype=np.uint32)
        places, counts = block.targets_m[called], called.sum(axis=1)
        yield Rows("/world/targets/calls", block, rings(places, self._sizes.call_radius_m, amber, counts))

    def _names(self, block: Block) -> Iterator[Rows]:
        """The names of those present, anew whenever that changes: the n-th name belongs to the n-th place."""
        changed = []
        for observation, present in zip(block.observations, block.present, strict=True):
            if self._named is None or not np.array_equal(present, self._named):
                changed.append(observation)
                self._named = present
        at = Block(self._scene, changed)
        names = [self._scene.target_names[target] for _, target in np.argwhere(at.present)]
        yield Rows("/world/targets/body", at, rr.Points3D.columns(labels=names).partition(at.present.sum(axis=1)))
