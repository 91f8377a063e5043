"""The swarm from above, once a second: on the globe, and as a graph of who hears whom."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
import rerun as rr

from comms.frames import geo_from_enu
from missions.recording import palette
from missions.recording.block import Block, Floats
from missions.recording.columns import Rows
from missions.recording.scene import Scene

# The side of the radio graph in its own units; a node's label is about 30 wide.
GRAPH_SIZE = 220.0

_STEP_S = 1.0


class Places:
    """The swarm from above, once a second: on the globe, and as a graph of who hears whom."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def rows(self, block: Block) -> Iterator[Rows]:
        """Places of agents and targets, nodes and edges of the radio."""
        block = block.every(_STEP_S)
        each = [self._scene.n_agents] * len(block)
        agents = rr.GeoPoints.columns(positions=self._geo(block.positions_m), colors=block.colors.ravel())
        yield Rows("/geo/agents", block, agents.partition(each))
        colors = np.where(block.seen, palette.TAGGED, palette.UNSEEN).astype(np.uint32)[block.present]
        targets = rr.GeoPoints.columns(positions=self._geo(block.targets_m[block.present]), colors=colors)
        yield Rows("/geo/targets", block, targets.partition(block.present.sum(axis=1)))
        yield Rows("/radio/graph", block, self._nodes(block).partition(each))
        edges = [(a, b) for seen in block.observations for a, b in seen.links]
        names = self._scene.agent_names
        columns = rr.GraphEdges.columns(edges=[(names[a], names[b]) for a, b in edges])
        yield Rows("/radio/graph", block, columns.partition([len(seen.links) for seen in block.observations]))

    def _nodes(self, block: Block) -> rr.ComponentColumnList:
        """Nodes where the agents are, north up: a graph's second axis points down."""
        arena = self._scene.arena
        scale = GRAPH_SIZE / (2 * max(arena.half_x_m, arena.half_y_m))
        flat = block.positions_m[..., :2] * (scale, -scale)
        names = self._scene.agent_names * len(block)
        return rr.GraphNodes.columns(
            node_ids=names, labels=names, positions=flat.reshape(-1, 2).astype(np.float32), colors=block.colors.ravel()
        )

    def _geo(self, places_m: Floats) -> npt.NDArray[np.float64]:
        """(..., 3) ENU as (P, 2) degrees of latitude and longitude."""
        points = [geo_from_enu(self._scene.home, (x, y, z)) for x, y, z in places_m.reshape(-1, 3).tolist()]
        return np.array([(point.latitude_deg, point.longitude_deg) for point in points]).reshape(-1, 2)
