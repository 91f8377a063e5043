"""Who has to do with whom, in 3D: agents with the targets they follow, radio links, help on its way."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import rerun as rr

from comms.status import Activity
from missions.observation import Observation
from missions.recording import palette
from missions.recording.block import LINE_STEP_S, Block
from missions.recording.columns import Rows, pieces
from missions.recording.scene import Scene


class Relations:
    """Draws a line from each agent to its tags and its mates, a red one where a frame was lost, and an arrow from each
    helper to where it is needed.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def rows(self, block: Block) -> Iterator[Rows]:
        """Lines and arrows; empty rows where there are none, or the last ones would stay."""
        block = block.every(LINE_STEP_S)
        yield Rows("/world/tracks", block, self._tracks(block))
        yield Rows("/world/links", block, self._between(block, [seen.links for seen in block.observations]))
        yield Rows("/world/broken", block, self._between(block, [seen.broken for seen in block.observations]))
        yield Rows("/world/help", block, self._help(block))

    def _tracks(self, block: Block) -> rr.ComponentColumnList:
        ends = [
            (row, status.uid, target)
            for row, seen in enumerate(block.observations)
            for status in seen.statuses
            for target in status.tags
        ]
        row, agent, target = np.array(ends, dtype=np.intp).reshape(-1, 3).T
        lines = np.stack((block.positions_m[row, agent], block.targets_m[row, target]), axis=1)
        counts = np.bincount(row, minlength=len(block))
        return pieces(lines, block.colors[row, agent], counts)

    def _between(self, block: Block, pairs: Sequence[Sequence[tuple[int, int]]]) -> rr.ComponentColumnList:
        """A line for each pair of agents in each tick."""
        ends = [(row, a, b) for row, some in enumerate(pairs) for a, b in some]
        row, a, b = np.array(ends, dtype=np.intp).reshape(-1, 3).T
        lines = np.stack((block.positions_m[row, a], block.positions_m[row, b]), axis=1)
        return pieces(lines, None, np.bincount(row, minlength=len(block)))

    def _help(self, block: Block) -> rr.ComponentColumnList:
        answers = [
            (row, status.uid, status.helping)
            for row, seen in enumerate(block.observations)
            for status in seen.statuses
            if status.helping is not None
        ]
        row, agent, target = np.array(answers, dtype=np.intp).reshape(-1, 3).T
        origins = block.positions_m[row, agent]
        columns = rr.Arrows3D.columns(
            origins=origins,
            vectors=block.targets_m[row, target] - origins,
            colors=np.full(len(answers), palette.ACTIVITY_INKS[Activity.HELPING], dtype=np.uint32),
            labels=[self._label(block.observations[k], helper, wanted) for k, helper, wanted in answers],
        )
        return columns.partition(np.bincount(row, minlength=len(block)))

    def _label(self, seen: Observation, helper: int, target: int) -> str:
        agents, targets = self._scene.agent_names, self._scene.target_names
        callers = [s.uid for s in seen.statuses if any(call.target == target for call in s.calls)]
        return f"{agents[helper]} helps {agents[callers[0]]}" if callers else f"{agents[helper]} to {targets[target]}"
