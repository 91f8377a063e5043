"""The air between the agents: it alone hears every frame, and passes on what the link model lets through.

Range is thus a fact of the world, not a promise of the receiver: an agent cannot read what did not reach it.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from comms import link
from comms.bundle import MAX_FRAMES, Heard, bundle
from comms.cells import Cells
from comms.codec import MAX_FRAME_BYTES
from comms.disturbance import CALM, Disturbance
from comms.keys import Keys, sender
from comms.session import Bus
from comms.turns import Turns


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkModel:
    """How far and how well frames travel: range (m), loss probability per frame and receiver, latency (s)."""

    range_m: float
    loss: float = 0.0
    latency_s: float = 0.0


@dataclass(slots=True)
class AirCount:
    """What happened to frames so far, counted per frame (sent, bytes, refused) and per frame and receiver (the rest).

    refused: nobody of this mission spoke it, it is too long to be a frame, or its speaker says too many.
    """

    sent: int = 0
    bytes: int = 0
    delivered: int = 0
    out_of_range: int = 0
    lost: int = 0
    refused: int = 0


class Air:
    """The medium of one mission. Frames gather in `tx/*`; `carry` moves them once a tick.

    Attributes:
        count: totals. links: pairs (a, b), a < b, that heard each other in the last tick.
        broken: pairs (from, to) of the last tick's frames that were lost within range. due: how many frames the last
            `carry` sent to each radio, by uid.
    """

    def __init__(self, bus: Bus, *, keys: Keys, model: LinkModel, n_agents: int, tick_s: float, seed: int) -> None:
        self._model = model
        self._seed = seed
        self._n_agents = n_agents
        self._tick_s = tick_s
        self._delay_ticks = link.delay_ticks(model.latency_s, tick_s)
        # Frames may come from another thread while others are carried.
        self._spoken = Turns(n_agents)
        self._under_way: dict[int, list[tuple[int, int, bytes]]] = {}  # by due tick: (dst, src, payload)
        self._puts = [bus.publisher(keys.rx(uid)) for uid in range(n_agents)]
        self.count = AirCount()
        self.links: tuple[tuple[int, int], ...] = ()
        self.broken: tuple[tuple[int, int], ...] = ()
        self.due = [0] * n_agents
        bus.subscribe(keys.every_tx, self._hear)

    def missing(self, speakers: Collection[int]) -> list[int]:
        """Which of these have spoken nothing since frames were carried last."""
        return self._spoken.missing(speakers)

    def _hear(self, key: str, payload: bytes) -> None:
        src = sender(key)
        if len(payload) > MAX_FRAME_BYTES or not self._spoken.put(src, payload):
            self.count.refused += 1

    def carry(self, tick: int, positions_m: Sequence[tuple[float, float]], disturbance: Disturbance = CALM) -> int:
        """Deliver what must be heard at tick + 1. Returns the number of deliveries.

        Args:
            tick: the tick whose frames have all been spoken.
            positions_m: every agent's true (x, y) at that tick, by uid.
            disturbance: what is wrong with the links at that tick.
        """
        range_m, count = self._model.range_m, self.count
        broken: list[tuple[int, int]] = []
        cells = Cells(positions_m, range_m=range_m)
        for src, payload in self._spoken.take():
            count.sent += 1
            count.bytes += len(payload)
            x, y = positions_m[src]
            count.out_of_range += self._n_agents - 1
            for dst in cells.near(x, y):
                other_x, other_y = positions_m[dst]
                if dst == src or not link.in_range(other_x - x, other_y - y, range_m):
                    continue
                count.out_of_range -= 1
                loss, delay_ticks = self._quality(tick, src, dst, disturbance)
                if link.survives(self._seed, tick, src, dst, loss):
                    self._under_way.setdefault(tick + delay_ticks, []).append((dst, src, payload))
                else:
                    broken.append((src, dst))
        count.lost += len(broken)
        self.broken = tuple(broken)
        links = set()
        arriving: list[list[Heard]] = [[] for _ in range(self._n_agents)]
        for dst, src, payload in self._under_way.pop(tick + 1, ()):
            arriving[dst].append((src, payload))
            links.add((src, dst) if src < dst else (dst, src))
        for put, frames in zip(self._puts, arriving, strict=True):
            if frames:
                put(bundle(frames))
        self.due = [min(len(frames), MAX_FRAMES) for frames in arriving]
        delivered = sum(self.due)
        count.delivered += delivered
        self.links = tuple(sorted(links))
        return delivered

    def _quality(self, tick: int, src: int, dst: int, disturbance: Disturbance) -> tuple[float, int]:
        """How likely a frame from `src` to `dst` is lost, and after how many ticks it is heard."""
        model = self._model
        if disturbance is CALM:
            return model.loss, self._delay_ticks
        loss, later_s = disturbance.of(tick, src, dst, seed=self._seed)
        return 1.0 - (1.0 - model.loss) * (1.0 - loss), link.delay_ticks(model.latency_s + later_s, self._tick_s)
