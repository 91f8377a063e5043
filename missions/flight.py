"""A whole mission in one process: agents, their vehicles or links to them, the air between them, the world below.

with open_local_bus() as bus:
    flight = Flight(mission, bus)
    flight.run(pace=Lockstep(), observers=[metrics], stop=lambda: False)
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import MappingProxyType
from typing import Protocol

from comms.clock import Pace
from comms.session import Bus
from comms.transport import Transport
from missions import compose
from missions.mission import Mission
from missions.observation import Observer
from missions.sides.agent import agent_sides
from missions.sides.exchange import Cue, Done
from missions.sides.world import WorldSide, fly
from swarm_agent.agent import Agent


class Flight:
    """One mission from power-on to landed. Everything in it follows from the mission; only the pace comes from outside.

    Args:
        transports: open, by uid: of the agents whose vehicles are not simulated.

    Attributes:
        side: the world's side, whose targets and coverage are `world` and `coverage`.
        crew: the agents' sides, by uid, whose brains and bodies are `agents` and `vehicles`.
    """

    def __init__(self, mission: Mission, bus: Bus, transports: Mapping[int, Transport] = MappingProxyType({})) -> None:
        self.mission = mission
        self.side = WorldSide(mission, bus)
        self.world, self.coverage = self.side.world, self.side.coverage
        n_targets = len(self.world.places)
        radios = compose.radios(mission, bus, range(mission.agents.count), n_targets)
        self.crew = agent_sides(mission, radios, n_targets=n_targets, transports=transports)
        self.vehicles = [side.vehicle for side in self.crew]

    @property
    def agents(self) -> list[Agent]:
        """Every agent as its computer runs it now, by uid."""
        return [side.agent for side in self.crew]

    @property
    def clock_s(self) -> float:
        """The mission clock: seconds since power-on."""
        return self.side.clock_s

    @property
    def ticks_flown(self) -> int:
        """Ticks of MISSION so far."""
        return self.side.ticks_flown

    @property
    def complete(self) -> bool:
        """Whether targets were watched for the mission's whole duration."""
        return self.side.complete

    def run(
        self,
        *,
        pace: Pace,
        observers: Iterable[Observer],
        stop: Callable[[], bool],
        attended: Sequence[Member] | None = None,
    ) -> None:
        """Fly until everybody has landed or is lost.

        Args:
            stop: asked every tick; once true, the swarm comes home.
            attended: who is called for each side, by uid, where it is not the side itself.
        """
        self.side.meet([side.hello() for side in self.crew])
        crew = _InProcess(self.crew if attended is None else attended)
        with _settled():
            fly(self.side, crew, pace=pace, observers=observers, stop=stop)


class Member(Protocol):
    """Who does an agent's ticks."""

    def tick(self, cue: Cue) -> Done: ...


@contextmanager
def _settled() -> Iterator[None]:
    """What is there already stays as long as the flight: Python's collector of garbage need not look at it each time.

    Else it would, again and again: at a thousand agents that takes a third of the time.
    """
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()


class _InProcess:
    """A crew that is called, one after the other."""

    def __init__(self, sides: Sequence[Member]) -> None:
        self._sides = sides

    def tick(self, cues: Sequence[Cue]) -> list[Done]:
        return [side.tick(cue) for side, cue in zip(self._sides, cues, strict=True)]
