"""The swarm from above, once a second: on the globe, and as a graph of who hears whom."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import Any

import numpy as np
import numpy.typing as npt
import rerun as rr

from comms.frames import geo_from_enu
from missions.recording import palette
from missions.recording.block import Block
from missions.recording.columns import Rows, doing, faded
from missions.recording.scene import Scene
from missions.recording.swarm import GROUNDED

# The side of the radio graph in its own units; a node's label is about 30 wide.
GRAPH_SIZE = 220.0

_STEP_S = 1.0
_SIGHT_ALPHA, _TRAIL_ALPHA = 200, 170
# Degrees on the map end in zeros, which pack well: steps of 5 cm.
_PER_DEGREE = 2.0**21
# Rings of more agents than this hide more than they tell.
_RINGED = 40
_AROUND = np.linspace(0.0, 2 * pi, 21)
_RING = np.column_stack((np.cos(_AROUND), np.sin(_AROUND), np.zeros_like(_AROUND)))


class Places:
    """The swarm from above, once a second: on the globe, and as a graph of who hears whom."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._before: npt.NDArray[np.float64] | None = None  # where agents were a second ago, degrees

    def rows(self, block: Block) -> Iterator[Rows]:
        """Places of agents and targets, nodes and edges of the radio."""
        block = block.every(_STEP_S)
        if not len(block):
            return
        each = [self._scene.n_agents] * len(block)
        places = self._geo(block.positions_m)
        agents = rr.GeoPoints.columns(positions=places, colors=block.colors.ravel())
        yield Rows("/geo/agents", block, agents.partition(each))
        if self._scene.n_agents <= _RINGED:
            yield Rows("/geo/sight", block, self._sight(block))
        yield Rows("/geo/trail", block, self._trail(block, places).partition(each))
        colors = np.where(block.seen, palette.TAGGED, palette.UNSEEN).astype(np.uint32)[block.present]
        targets = rr.GeoPoints.columns(positions=self._geo(block.targets_m[block.present]), colors=colors)
        yield Rows("/geo/targets", block, targets.partition(block.present.sum(axis=1)))
        yield Rows("/radio/graph", block, self._nodes(block).partition(each))
        edges = [(a, b) for seen in block.observations for a, b in seen.links]
        names = self._scene.agent_names
        columns = rr.GraphEdges.columns(edges=[(names[a], names[b]) for a, b in edges])
        yield Rows("/radio/graph", block, columns.partition([len(seen.links) for seen in block.observations]))

    def _sight(self, block: Block) -> rr.ComponentColumnList:
        """A ring as far as each agent in the air sees, also around those that see a sector of it."""
        flying = doing(block, lambda activity: activity not in GROUNDED)
        ranges = np.broadcast_to(np.array(self._scene.sensing_ranges_m), flying.shape)[flying]
        rings = block.positions_m[flying][:, None, :] + ranges[:, None, None] * _RING
        lines = self._geo(rings).reshape(-1, len(_RING), 2)
        colors = faded(block.colors[flying], _SIGHT_ALPHA)
        columns = rr.GeoLineStrings.columns(line_strings=list(lines), colors=colors)
        return columns.partition(flying.sum(axis=1))

    def _trail(self, block: Block, places: npt.NDArray[np.float64]) -> rr.ComponentColumnList:
        """From where each agent was a second ago to where it is: the view shows the latest of these pieces."""
        ends = places.reshape(len(block), self._scene.n_agents, 2)
        starts = np.concatenate(([ends[0] if self._before is None else self._before], ends[:-1]))
        self._before = ends[-1]
        pieces = np.stack((starts, ends), axis=2).reshape(-1, 2, 2)
        return rr.GeoLineStrings.columns(line_strings=list(pieces), colors=faded(block.colors.ravel(), _TRAIL_ALPHA))

    def _nodes(self, block: Block) -> rr.ComponentColumnList:
        """Nodes where the agents are, north up: a graph's second axis points down."""
        arena = self._scene.arena
        scale = GRAPH_SIZE / (2 * max(arena.half_x_m, arena.half_y_m))
        flat = block.positions_m[..., :2] * (scale, -scale)
        names = self._scene.agent_names * len(block)
        return rr.GraphNodes.columns(
            node_ids=names, labels=names, positions=flat.reshape(-1, 2).astype(np.float32), colors=block.colors.ravel()
        )

    def _geo(self, places_m: npt.NDArray[np.floating[Any]]) -> npt.NDArray[np.float64]:
        """(..., 3) ENU as (P, 2) degrees of latitude and longitude."""
        points = [geo_from_enu(self._scene.home, (x, y, z)) for x, y, z in places_m.reshape(-1, 3).tolist()]
        degrees = np.array([(point.latitude_deg, point.longitude_deg) for point in points]).reshape(-1, 2)
        return np.round(degrees * _PER_DEGREE) / _PER_DEGREE
