"""The targets of a mission, as a whole: where each is now, and one tick on.

Every kind of motion is one small class with `places` and `advance`; the world does not care which it has.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from comms.arena import Arena, clamped
from comms.cells import Cells
from vehicle_sim import targets
from vehicle_sim.tracks import Tracks

Place = tuple[float, float]


class Herd(Protocol):
    """Targets, by id. `places` holds (x, y) in ENU meters, or None for a target that is not in the world now."""

    places: list[Place | None]

    def advance(self, tick: int, agents_x: Sequence[float], agents_y: Sequence[float]) -> None:
        """Move from state `tick` to `tick` + 1, given where the agents are at `tick`."""
        ...


class _Walkers:
    """Targets with a heading. `places` and `headings` are by target; the rule is `_step`."""

    def __init__(
        self, *, arena: Arena, places: Sequence[Place], headings: Sequence[Place], tick_s: float, seed: int
    ) -> None:
        self.places: list[Place | None] = list(places)
        self._states: list[targets.State] = [
            (*place, *heading) for place, heading in zip(places, headings, strict=True)
        ]
        self._arena = arena
        self._tick_s = tick_s
        self._seed = seed

    def advance(self, tick: int, agents_x: Sequence[float], agents_y: Sequence[float]) -> None:
        for target, state in enumerate(self._states):
            state = self._step(target, state, tick, agents_x, agents_y)
            self._states[target] = state
            self.places[target] = state[:2]

    def _step(
        self, target: int, state: targets.State, tick: int, agents_x: Sequence[float], agents_y: Sequence[float]
    ) -> targets.State:
        return state


class Static(_Walkers):
    """Targets that stand still."""


class Evasive(_Walkers):
    """Targets that flee from the agents they notice, at `speed_m_s`; see `targets.evade`."""

    def __init__(
        self,
        *,
        arena: Arena,
        places: Sequence[Place],
        headings: Sequence[Place],
        tick_s: float,
        seed: int,
        speed_m_s: float,
        notice_range_m: float,
    ) -> None:
        super().__init__(arena=arena, places=places, headings=headings, tick_s=tick_s, seed=seed)
        self._speed_m_s = speed_m_s
        self._notice_range_m = notice_range_m
        self._cells = Cells((), range_m=notice_range_m)

    def advance(self, tick: int, agents_x: Sequence[float], agents_y: Sequence[float]) -> None:
        self._cells = Cells(list(zip(agents_x, agents_y, strict=True)), range_m=self._notice_range_m)
        super().advance(tick, agents_x, agents_y)

    def _step(
        self, target: int, state: targets.State, tick: int, agents_x: Sequence[float], agents_y: Sequence[float]
    ) -> targets.State:
        near = self._cells.near(*state[:2])  # of the others it notices nothing
        return targets.evade(
            self._arena,
            *state,
            [agents_x[i] for i in near],
            [agents_y[i] for i in near],
            self._notice_range_m,
            self._speed_m_s,
            self._tick_s,
            self._seed,
            tick,
            target,
        )


class Random(_Walkers):
    """Targets that walk straight and turn by chance, at `speed_m_s`; see `targets.roam`."""

    def __init__(
        self,
        *,
        arena: Arena,
        places: Sequence[Place],
        headings: Sequence[Place],
        tick_s: float,
        seed: int,
        speed_m_s: float,
    ) -> None:
        super().__init__(arena=arena, places=places, headings=headings, tick_s=tick_s, seed=seed)
        self._speed_m_s = speed_m_s

    def _step(
        self, target: int, state: targets.State, tick: int, agents_x: Sequence[float], agents_y: Sequence[float]
    ) -> targets.State:
        return targets.roam(self._arena, *state, self._speed_m_s, self._tick_s, self._seed, tick, target)


class Replay:
    """Targets that repeat recorded tracks from `start_s` on, held at the edge while a track is outside the arena."""

    def __init__(self, *, arena: Arena, tracks: Tracks, tick_s: float, start_s: float = 0.0) -> None:
        self._arena = arena
        self._tracks = tracks
        self._tick_s = tick_s
        self._start_s = start_s
        self.places: list[Place | None] = [None] * len(tracks.names)
        self._show(0)

    def advance(self, tick: int, agents_x: Sequence[float], agents_y: Sequence[float]) -> None:
        self._show(tick + 1)

    def _show(self, tick: int) -> None:
        time_s = self._start_s + tick * self._tick_s
        for target in range(len(self.places)):
            fix = self._tracks.at(target, time_s)
            self.places[target] = None if fix is None else clamped(self._arena, fix[0], fix[1])
