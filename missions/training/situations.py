"""What the predictor learns from: one agent with two or three targets until it loses one, and nobody interferes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from missions.study.engine import Trace


class Situation(NamedTuple):
    """Agent `agent` has `targets` in every tick from `first` on, until one of them is out of sight at tick `loss`."""

    agent: int
    targets: tuple[int, ...]
    first: int
    loss: int


def find_situations(trace: Trace, n_tags: int, *, notice_range_m: float) -> list[Situation]:
    """All situations of `n_tags` targets in a run, by agent, then by tick.

    In each of its ticks (those before `loss`) the agent tags exactly these targets; it senses no other target; and no
    other agent is within `notice_range_m` of any of them, so that they flee from this agent alone. It ends by a loss:
    at tick `loss` the agent no longer senses one of them. Stretches that end otherwise (another agent comes near or
    takes a tag, a third target comes into sight, the run ends) are none. Nothing is asked of the arena's edge.
    """
    agents = range(trace.agents.shape[1])
    return [situation for agent in agents for situation in _of_agent(trace, agent, n_tags, notice_range_m)]


def _of_agent(trace: Trace, agent: int, n_tags: int, notice_range_m: float) -> Iterator[Situation]:
    tagged, sensed = trace.tagged[:, agent], trace.sensed[:, agent]
    alone = (tagged.sum(axis=1) == n_tags) & (tagged == sensed).all(axis=1)
    alone &= ~(tagged & _noticed_by_others(trace, agent, notice_range_m)).any(axis=1)
    goes_on = alone[1:] & alone[:-1] & (tagged[1:] == tagged[:-1]).all(axis=1)
    first = 0
    for tick in np.flatnonzero(~goes_on).tolist():
        end = tick + 1
        if alone[first] and (tagged[first] & ~sensed[end]).any():
            yield Situation(agent, tuple(np.flatnonzero(tagged[first]).tolist()), first, end)
        first = end


def _noticed_by_others(trace: Trace, agent: int, range_m: float) -> npt.NDArray[np.bool_]:
    """Whether each target notices an agent other than `agent`: (T, n)."""
    others = np.delete(trace.agents, agent, axis=1)
    gaps = others[:, :, None] - trace.targets[:, None]
    near: npt.NDArray[np.bool_] = np.any((gaps**2).sum(axis=-1) <= range_m * range_m, axis=1)
    return near
