"""How frames get from agent to agent, as far as the world knows: through its own air, or from radio to radio."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Protocol

from comms.air import Air, AirCount
from comms.disturbance import Disturbance
from missions.sides.exchange import Done


class Medium(Protocol):
    """What carries the frames of a mission.

    Attributes:
        count: totals. due: how many frames wait for each agent's next tick, by uid.
        links: pairs (a, b), a < b, that heard each other in the last tick.
        broken: pairs (from, to) of the last tick's frames that were lost within range.
    """

    @property
    def count(self) -> AirCount: ...

    @property
    def due(self) -> Sequence[int]: ...

    @property
    def links(self) -> tuple[tuple[int, int], ...]: ...

    @property
    def broken(self) -> tuple[tuple[int, int], ...]: ...

    def carry(self, tick: int, before: Sequence[Done], dones: Sequence[Done], disturbance: Disturbance) -> None:
        """See to what was sent in this tick. By uid, `before` is how agents were when it began, `dones` what came."""

    def missing(self, speakers: Collection[int]) -> list[int]:
        """Which of these have sent frames that are not where they must be before the tick can end."""


class SimulatedAir:
    """The world carries every frame, as far as its link model lets it. See `Medium`."""

    def __init__(self, air: Air) -> None:
        self._air = air

    @property
    def count(self) -> AirCount:
        return self._air.count

    @property
    def due(self) -> Sequence[int]:
        return self._air.due

    @property
    def links(self) -> tuple[tuple[int, int], ...]:
        return self._air.links

    @property
    def broken(self) -> tuple[tuple[int, int], ...]:
        return self._air.broken

    def carry(self, tick: int, before: Sequence[Done], dones: Sequence[Done], disturbance: Disturbance) -> None:
        self._air.carry(tick, [done.truth.position_m[:2] for done in before], disturbance)

    def missing(self, speakers: Collection[int]) -> list[int]:
        return self._air.missing(speakers)


class OpenField:
    """Radios reach each other, and the world learns from the agents alone what was sent and heard. See `Medium`.

    What did not arrive counts as out of range: whether it was, or was lost on the way, nobody knows. Nothing counts as
    lost, and no link as broken.
    """

    broken = ()

    def __init__(self, n_agents: int) -> None:
        self.count = AirCount()
        self.due = [0] * n_agents
        self.links: tuple[tuple[int, int], ...] = ()

    def carry(self, tick: int, before: Sequence[Done], dones: Sequence[Done], disturbance: Disturbance) -> None:
        n_agents, radios, spoke = len(dones), [done.radio for done in dones], sum(done.spoke for done in dones)
        self.due = [spoke - done.spoke for done in dones]
        sent, heard = sum(radio.sent for radio in radios), sum(radio.heard for radio in radios)
        reached = heard + sum(radio.refused for radio in radios) + sum(self.due)
        self.count = AirCount(
            sent=sent,
            bytes=sum(radio.bytes for radio in radios),
            delivered=heard,
            out_of_range=max(0, sent * (n_agents - 1) - reached),
        )
        heard_each_other = {
            (min(uid, mate), max(uid, mate))
            for uid, done in enumerate(dones)
            for mate in done.status.mates
            if 0 <= mate < n_agents and mate != uid
        }
        self.links = tuple(sorted(heard_each_other))

    def missing(self, speakers: Collection[int]) -> list[int]:
        return []
