"""The ground as a map of memory: bright where agents look now, fading where they looked before."""

from __future__ import annotations

from collections.abc import Iterator
from math import floor

import numpy as np
import numpy.typing as npt
import rerun as rr

from comms.status import Activity
from missions.recording import palette, shapes
from missions.recording.block import Block, Colors, Floats, Mask
from missions.recording.columns import Rows, doing, ramp
from missions.recording.scene import Scene
from missions.recording.sight import Sight

_BLIND = frozenset({Activity.PREPARING, Activity.LANDED, Activity.LOST})
_PAINT_STEP_S = 1.0

# All the ground fades together, in few steps: between two of them only newly seen ground changes, and that packs well.
_FADE_STEP_S = 5.0
_REMEMBERED, _FRESH = 6, 18  # shades, of 0 for never seen
_NEVER = np.iinfo(np.int64).min // 2


class SeenGround:
    """Colors the vertices of the ground by when an agent last had them in range."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        vertices, _ = shapes.ground_mesh(scene.arena)
        self._vertices = np.ascontiguousarray(vertices.T)
        self._seen_at_step = np.full(len(vertices), _NEVER, dtype=np.int64)
        self._shape = shapes.ground_shape(scene.arena)
        old = ramp(palette.GROUND, palette.GROUND_REMEMBERED, _REMEMBERED + 1)
        new = ramp(palette.GROUND_REMEMBERED, palette.GROUND_FRESH, _FRESH - _REMEMBERED + 1)
        self._ramp = np.concatenate((old, new[1:]))
        self._sight = Sight(scene)
        self._bare = True

    def rows(self, block: Block) -> Iterator[Rows]:
        """The ground's colors, once a second, and at the very first tick."""
        facings = self._sight.facings(block)
        shown = block.every(_PAINT_STEP_S)
        if self._bare and block.ticks[0] not in shown.ticks:
            shown = Block(self._scene, [block.observations[0], *shown.observations])
        self._bare = False
        looking = doing(shown, lambda activity: activity not in _BLIND)
        facing = [facings[tick] for tick in shown.ticks.tolist()]
        colors = list(map(self._paint, shown.times_ns / 1e9, shown.positions_m, facing, looking))
        columns = rr.Mesh3D.columns(vertex_colors=np.array(colors, dtype=np.uint32).ravel())
        yield Rows("/world/seen", shown, columns.partition([self._vertices.shape[1]] * len(shown)))

    def _paint(self, now_s: float, positions_m: Floats, facing: Floats, looking: Mask) -> Colors:
        """The color of every vertex, after agents at (N, 3) have looked around."""
        step = floor(now_s / _FADE_STEP_S)
        self._seen_at_step[self._sight.covers(self._vertices, positions_m[:, :2], facing, looking)] = step
        shade = np.maximum(_FRESH - (step - self._seen_at_step), _REMEMBERED)
        shade[self._seen_at_step == _NEVER] = 0
        return self._ramp[_softened(_softened(shade.reshape(self._shape))).ravel()]


def _softened(shade: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Each place halfway towards the mean of its four neighbors: edges without stairs."""
    padded = np.pad(shade, 1, mode="edge")
    around = padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]
    return (4 * shade + around) // 8
