"""What is plotted over time: how well the mission goes, and the agents' telemetry."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import rerun as rr

from missions.observation import Observation
from missions.recording.block import Block, Floats
from missions.recording.columns import Rows
from missions.recording.scene import Scene

_STEP_S = 1.0
_FRAME_COUNTS = 4
UNKNOWN = -1.0  # a battery nobody has heard of yet, beside others known; NaN is not equal to itself


class Metrics:
    """How well the mission goes: coverage, utilization, radio traffic a second."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._radio: Observation | None = None

    def rows(self, block: Block) -> Iterator[Rows]:
        """Coverage at every tick of the mission proper; radio once a second."""
        counted = Block(self._scene, [seen for seen in block.observations if seen.coverage is not None])
        now_and_mean = [(seen.coverage, seen.coverage_mean) for seen in counted.observations]
        yield Rows("/metrics/coverage", counted, _vectors(now_and_mean, 2))
        seconds = counted.every(_STEP_S)
        yield Rows("/metrics/utilization", seconds, _vectors([(s.utilization,) for s in seconds.observations], 1))
        if self._scene.coverage_floor is not None:
            yield Rows("/metrics/floor", seconds, _vectors([(self._scene.coverage_floor,)] * len(seconds), 1))
        yield from self._traffic(block.every(_STEP_S))

    def _traffic(self, block: Block) -> Iterator[Rows]:
        rates, since = [], []
        for seen in block.observations:
            before, self._radio = self._radio, seen
            if before is None or seen.time_s <= before.time_s:
                continue
            span_s = seen.time_s - before.time_s
            rates.append([(now - then) / span_s for now, then in zip(_frames(seen), _frames(before), strict=True)])
            since.append(seen)
        yield Rows("/metrics/net", Block(self._scene, since), _vectors(rates, _FRAME_COUNTS))


def _frames(seen: Observation) -> tuple[int, ...]:
    """Totals of radio frames, in the order of their lines."""
    totals = seen.totals
    return totals.radio_sent, totals.radio_delivered, totals.radio_lost, totals.radio_out_of_range


class Telemetry:
    """Vectors over the agents, once a second: battery, altitude, speed; and how late each tick was."""

    def __init__(self, scene: Scene) -> None:
        self._n = scene.n_agents
        self._late_s: float | None = None
        self._batteries = np.full(scene.n_agents, UNKNOWN, dtype=np.float32)

    def rows(self, block: Block) -> Iterator[Rows]:
        """The telemetry."""
        late = self._late(block)
        yield Rows("/telemetry/tick_late", late, _vectors([(seen.tick_late_s,) for seen in late.observations], 1))
        block = block.every(_STEP_S)
        yield self._charges(block)
        yield Rows("/telemetry/altitude", block, _vectors(block.positions_m[..., 2], self._n))
        yield Rows("/telemetry/speed", block, _vectors(block.speeds_m_s, self._n))

    def _charges(self, block: Block) -> Rows:
        """What was heard last of each battery, from the moment on at which one is known."""
        told, rows = [], []
        for seen, heard in zip(block.observations, block.batteries, strict=True):
            self._batteries = np.where(np.isnan(heard), self._batteries, heard)
            if (self._batteries != UNKNOWN).any():
                told.append(seen)
                rows.append(self._batteries)
        return Rows("/telemetry/battery", Block(block.scene, told), _vectors(np.array(rows), self._n))

    def _late(self, block: Block) -> Block:
        """The ticks at which lateness changed, and one a second: in lockstep no tick is ever late."""
        told, seconds = [], {*block.every(_STEP_S).ticks.tolist()}
        for seen in block.observations:
            if seen.tick_late_s != self._late_s or seen.tick in seconds:
                told.append(seen)
            self._late_s = seen.tick_late_s
        return Block(block.scene, told)


def _vectors(rows: Sequence[Sequence[float | None]] | Floats, width: int) -> rr.ComponentColumnList:
    """Rows of `width` scalars; None becomes nan."""
    values = np.asarray(rows, dtype=np.float64).reshape(-1)
    return rr.Scalars.columns(scalars=values).partition([width] * (len(values) // width))
