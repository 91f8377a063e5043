"""Situations tick by tick: what the net sees, how long it really took, and what eq. 10 would have said."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import sqrt

import numpy as np
import numpy.typing as npt

from missions.study.engine import Trace
from missions.training.situations import Situation
from swarm_agent.bcmommt.loss import time_to_leave
from swarm_agent.bcmommt.net import TAUGHT_S, pair_inputs, triple_inputs

Floats = npt.NDArray[np.float64]
Point = tuple[float, float]


@dataclass(frozen=True)
class Rows:
    """N rows; times are shares of 20 s.

    Attributes:
        inputs (N, 3 or 6): what the net sees. teacher (N): the time until the first loss. direct (N): the same by
            eq. 10, at most 1. situations: how many the rows are of.
    """

    inputs: Floats
    teacher: Floats
    direct: Floats
    situations: int


def rows_of(trace: Trace, situations: Sequence[Situation], *, tick_s: float, range_m: float) -> Rows:
    """The rows of a run's situations: a row per tick whose loss is at most 20 s away.

    The run's first tick has none: eq. 10 needs to have seen the targets move.
    """
    inputs: list[tuple[float, ...]] = []
    teacher: list[float] = []
    direct: list[float] = []
    most = round(TAUGHT_S / tick_s)
    told = 0
    for situation in situations:
        ticks = range(max(situation.first, situation.loss - most, 1), situation.loss)
        told += len(ticks) > 0
        for tick in ticks:
            me, now = _points(trace.agents[tick, [situation.agent]])[0], _points(trace.targets[tick, situation.targets])
            before = _points(trace.targets[tick - 1, situation.targets])
            inputs.append(inputs_of(me, now, range_m))
            teacher.append((situation.loss - tick) * tick_s / TAUGHT_S)
            direct.append(min(direct_loss_s(now, before, tick_s, range_m) / TAUGHT_S, 1.0))
    return Rows(np.array(inputs), np.array(teacher), np.array(direct), told)


def join(parts: Iterable[Rows]) -> Rows:
    """The rows of several runs."""
    some = [part for part in parts if len(part.teacher)]
    return Rows(
        np.concatenate([part.inputs for part in some]),
        np.concatenate([part.teacher for part in some]),
        np.concatenate([part.direct for part in some]),
        sum(part.situations for part in some),
    )


def inputs_of(me: Point, targets: Sequence[Point], range_m: float) -> tuple[float, ...]:
    """The inputs of the net for an agent at `me` over two or three targets."""
    distances = [_distance(me, target) for target in targets]
    gaps = [_distance(one, other) for one, other in combinations(targets, 2)]
    if len(targets) == 2:
        return pair_inputs(distances[0], distances[1], gaps[0], range_m)
    return triple_inputs(distances[0], distances[1], distances[2], gaps[0], gaps[1], gaps[2], range_m)


def direct_loss_s(now: Sequence[Point], before: Sequence[Point], tick_s: float, range_m: float) -> float:
    """When eq. 10 expects the first loss, s, from the targets' places now and one tick ago."""
    n = len(now)
    velocities = [((x - u) / tick_s, (y - v) / tick_s) for (x, y), (u, v) in zip(now, before, strict=True)]
    cx, cy = sum(x for x, _ in now) / n, sum(y for _, y in now) / n
    cu, cv = sum(u for u, _ in velocities) / n, sum(v for _, v in velocities) / n
    return min(
        time_to_leave(x - cx, y - cy, u - cu, v - cv, range_m) for (x, y), (u, v) in zip(now, velocities, strict=True)
    )


def _points(places: Floats) -> list[Point]:
    return [(float(x), float(y)) for x, y in places]


def _distance(a: Point, b: Point) -> float:
    dx, dy = a[0] - b[0], a[1] - b[1]
    return sqrt(dx * dx + dy * dy)
