"""What stands still while a mission is recorded: where it is flown, by how many, and with which settings."""

from __future__ import annotations

import uuid
from dataclasses import asdict, dataclass
from math import hypot, pi

from comms.arena import Arena
from comms.frames import GeoPoint
from missions.faults.schedule import Spell

# Any fixed namespace will do; this one makes equal scenes share one recording id.
_NAMESPACE = uuid.UUID("6f1d4c58-3c0e-5d3b-9a52-0f3c8f6a7d21")


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """Everything the recorder must know before the first tick.

    Attributes:
        mission_name: the recording's title. mission_yaml: the mission with every default and --set resolved.
        flown_at: when, of a flight in real time, which no other equals; empty where equal missions are equal flights.
        seed, policy, versions: stored as properties, beside the mission. versions: name -> version (or git hash).
        tick_s: mission time between two observations.
        sensing_ranges_m: how far each agent sees, on the ground, by uid.
        half_opening_rad: half the angle that agents see into, about their course; pi: all around.
        home: where ENU (0, 0, 0) is on the globe.
        ceiling_m: how high agents fly, so that the first view shows all of them.
        coverage_floor: coverage of agents placed at random and standing still, drawn as a dim line; None when unknown.
        faults: what the mission lets go wrong, in ticks since MISSION began.
    """

    mission_name: str
    mission_yaml: str
    seed: int
    policy: str
    versions: dict[str, str]
    tick_s: float
    arena: Arena
    n_agents: int
    n_targets: int
    sensing_ranges_m: tuple[float, ...]
    home: GeoPoint
    half_opening_rad: float = pi
    ceiling_m: float = 0.0
    coverage_floor: float | None = None
    flown_at: str = ""
    faults: tuple[Spell, ...] = ()

    @property
    def ticks_per_s(self) -> int:
        """Ticks in one second of mission time, at least 1."""
        return max(1, round(1.0 / self.tick_s))

    @property
    def sees_all_around(self) -> bool:
        """Whether what agents see is a disc, and not a sector."""
        return self.half_opening_rad >= pi

    @property
    def size_m(self) -> float:
        """The length that glyphs are scaled by: half the arena's diagonal, or a disc's radius times the same root 2."""
        return hypot(self.arena.half_x_m, self.arena.half_y_m)

    @property
    def agent_names(self) -> list[str]:
        """ "A0", "A1", ...: as agents call each other; the viewer sorts A2 before A10."""
        return agent_names(self.n_agents)

    @property
    def target_names(self) -> list[str]:
        """ "T0", "T1", ..."""
        return [f"T{target}" for target in range(self.n_targets)]

    @property
    def recording_id(self) -> str:
        """A UUID that depends on nothing but the scene, so that the same mission records the same.

        The viewer shows files of one id as one recording.
        """
        return str(uuid.uuid5(_NAMESPACE, repr(asdict(self))))


def agent_names(count: int) -> list[str]:
    """ "A0", "A1", ..."""
    return [f"A{uid}" for uid in range(count)]
