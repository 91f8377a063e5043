"""What goes wrong on the links for a while, beside what the link model lets through anyway.

    troubled = Disturbance(loss=(Trouble(0.3),), silent=frozenset({4}))
    troubled.of(tick, 1, 2, seed=7)  # (0.3, 0.0): the loss and the extra latency of what 1 sends to 2

A value without memory: what holds for a link at a tick follows from the tick, the link and the seed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from comms.chance import LINK_BURST, draw

_PAIR = 65_536  # one key per pair of agents


class Trouble(NamedTuple):
    """One trouble of the links of `agents` (None: of all): how much of it, and for bursts how many ticks each lasts."""

    amount: float
    agents: frozenset[int] | None = None
    ticks: int = 1

    def touches(self, src: int, dst: int) -> bool:
        """Whether the link between these two is one of those."""
        return self.agents is None or src in self.agents or dst in self.agents


@dataclass(frozen=True, slots=True, kw_only=True)
class Disturbance:
    """What is wrong with links in a tick.

    Attributes:
        silent: agents whose radio is dead. partitions: the group of each agent, by uid; other groups are not heard, and
            an agent in no group hears nobody.
        loss: amount is the probability that a frame is lost. bursts: amount is the share of time that a link is down,
            `ticks` at a stretch at least. latency: amount is in seconds.
    """

    silent: frozenset[int] = frozenset()
    partitions: tuple[dict[int, int], ...] = ()
    loss: tuple[Trouble, ...] = ()
    bursts: tuple[Trouble, ...] = ()
    latency: tuple[Trouble, ...] = ()

    def of(self, tick: int, src: int, dst: int, *, seed: int) -> tuple[float, float]:
        """Probability that a frame of `src` to `dst` is lost to this, and how much longer (s) it takes."""
        if self._is_cut(tick, src, dst, seed):
            return 1.0, 0.0
        passes = 1.0
        for trouble in self.loss:
            if trouble.touches(src, dst):
                passes *= 1.0 - trouble.amount
        return 1.0 - passes, sum(trouble.amount for trouble in self.latency if trouble.touches(src, dst))

    def _is_cut(self, tick: int, src: int, dst: int, seed: int) -> bool:
        if src in self.silent or dst in self.silent:
            return True
        if any(src not in group or group[src] != group.get(dst) for group in self.partitions):
            return True
        # Both ways of a link fail together, and every link by itself.
        pair = min(src, dst) * _PAIR + max(src, dst)
        return any(
            trouble.touches(src, dst) and draw(seed, tick // trouble.ticks, pair, LINK_BURST) < trouble.amount
            for trouble in self.bursts
        )


CALM = Disturbance()
