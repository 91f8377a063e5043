"""What agents see of the ground: a disc, or a sector ahead of them."""

from __future__ import annotations

from math import cos

import numpy as np

from missions.recording.block import Block, Floats, Ints, Mask, stored
from missions.recording.scene import Scene
from vehicle_sim.sensing import STANDING_M_S

# Sides of a sector's arc.
_SIDES = 12


class Sight:
    """Where agents look, from tick to tick: along their course over ground, or where they did while they stand."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._ranges_m = np.array(scene.sensing_ranges_m, dtype=np.float32)
        self._facing: Floats | None = None

    def facings(self, block: Block) -> dict[int, Floats]:
        """By tick (N, 2) unit vectors east and north; blocks are to be given one after the other, whole."""
        found = {}
        for seen, headings in zip(block.observations, block.headings_rad, strict=True):
            if self._facing is None:
                self._facing = np.stack((np.sin(headings), np.cos(headings)), axis=1)
            if seen.mission_tick is not None:
                velocity = np.array([truth.velocity_m_s[:2] for truth in seen.truths]).reshape(-1, 2)
                speed = np.linalg.norm(velocity, axis=1, keepdims=True)
                moves = speed >= STANDING_M_S
                self._facing = np.where(moves, velocity / np.where(moves, speed, 1.0), self._facing)
            found[seen.tick] = self._facing.astype(np.float32)
        return found

    def covers(self, places: Floats, eyes: Floats, facing: Floats, looking: Mask) -> Mask:
        """(P,): which places (2, P) are seen by those that look, of all agents at (N, 2), which face (N, 2).

        One agent after the other: a row of places is summed much faster than many short rows of agents.
        """
        seen = np.zeros(places.shape[1], dtype=np.bool_)
        for agent in np.flatnonzero(looking):
            east, north = places - eyes[agent][:, None]
            squared = east * east + north * north
            within = squared <= self._ranges_m[agent] ** 2
            if not self._scene.sees_all_around:
                ahead = east * facing[agent, 0] + north * facing[agent, 1]
                within &= ahead >= cos(self._scene.half_opening_rad) * np.sqrt(squared)
            seen |= within
        return seen

    def outlines(self, centers: Floats, facing: Floats, agents: Ints) -> Floats:
        """(A, P, 3) closed outlines of the sectors of agents (A,) above (A, 3) places on the ground."""
        bend = np.linspace(-1.0, 1.0, _SIDES + 1) * self._scene.half_opening_rad
        angles = np.arctan2(facing[:, 1], facing[:, 0])[:, None] + bend
        arc = self._ranges_m[agents][:, None, None] * np.stack((np.cos(angles), np.sin(angles)), axis=2)
        tip = np.zeros((len(centers), 1, 2))
        flat = np.concatenate((tip, arc, tip), axis=1)
        return stored(np.concatenate((flat, np.zeros_like(flat[..., :1])), axis=2) + centers[:, None, :])
