"""The agents in 3D: arrow and name, stem down to the ground, sensing disc, trail."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import rerun as rr

from comms.status import Activity
from missions.recording import shapes
from missions.recording.block import LINE_STEP_S, Block, Floats
from missions.recording.columns import Rows, doing, faded, pieces, rings
from missions.recording.scene import Scene
from missions.recording.sight import Sight
from missions.recording.stage import Sizes

GROUNDED = frozenset({Activity.PREPARING, Activity.LANDED})

# The trail is a chain of short pieces, each recorded once; the view shows the latest of them.
_TRAIL_STEP_S = 0.5
_DISC_ALPHA = 150
_FLAT = np.array((1, 1, 0), dtype=np.float32)


class Swarm:
    """Draws agents where their vehicles truly are, in the color of what they do."""

    def __init__(self, scene: Scene) -> None:
        self._n = scene.n_agents
        self._sight = Sight(scene)
        self._ranges_m = np.array(scene.sensing_ranges_m, dtype=np.float32)
        self._arrow_m = np.float32(Sizes.of(scene).arrow_m)
        self._trail_end_m: Floats | None = None

    def rows(self, block: Block) -> Iterator[Rows]:
        """Bodies at every tick, stems and sensing discs less often, a piece of trail twice a second."""
        yield from self._bodies(block)
        yield from self._footprints(block)
        yield from self._trail(block.every(_TRAIL_STEP_S))

    def _bodies(self, block: Block) -> Iterator[Rows]:
        colors, each = block.colors.ravel(), np.full(len(block), self._n)
        bodies = rr.Points3D.columns(positions=block.positions_m.reshape(-1, 3), colors=colors)
        yield Rows("/world/agents/body", block, bodies.partition(each))
        ahead = self._arrow_m * shapes.compass(block.headings_rad).reshape(-1, 3)
        tails = block.positions_m.reshape(-1, 3)
        arrows = rr.Arrows3D.columns(origins=tails, vectors=ahead, colors=colors)
        yield Rows("/world/agents/heading", block, arrows.partition(each))

    def _footprints(self, block: Block) -> Iterator[Rows]:
        facings = self._sight.facings(block)
        block = block.every(LINE_STEP_S)
        flying = doing(block, lambda activity: activity not in GROUNDED)
        here, colors, counts = block.positions_m[flying], block.colors[flying], flying.sum(axis=1)
        below = here * _FLAT
        stems = np.stack((here, below), axis=1)
        yield Rows("/world/agents/stem", block, pieces(stems, colors, counts))
        agents = np.nonzero(flying)[1]
        if block.scene.sees_all_around:
            seen = rings(below, self._ranges_m[agents], faded(colors, _DISC_ALPHA), counts)
        else:
            facing = np.array([facings[tick] for tick in block.ticks.tolist()]).reshape(*flying.shape, 2)[flying]
            seen = pieces(self._sight.outlines(below, facing, agents), colors, counts)
        yield Rows("/world/agents/sensing", block, seen)

    def _trail(self, block: Block) -> Iterator[Rows]:
        if not len(block):
            return
        ends = block.positions_m
        before = ends[:1] if self._trail_end_m is None else self._trail_end_m[None]
        starts = np.concatenate((before, ends[:-1]))
        self._trail_end_m = ends[-1]
        # The way straight up says nothing, and hides what is behind it.
        flying = doing(block, lambda activity: activity not in GROUNDED)
        steps = np.stack((starts, ends), axis=2)[flying]
        yield Rows("/world/agents/trail", block, pieces(steps, block.colors[flying], flying.sum(axis=1)))
