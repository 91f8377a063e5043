"""What is wrong at which tick of a mission: values, the same for everybody who knows the mission."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import ceil

from comms.disturbance import CALM, Disturbance, Trouble
from comms.status import Event, Level
from missions.faults.breakage import broken
from missions.faults.words import words
from missions.mission import Mission
from missions.mission.faults import (
    VEHICLE_FAULTS,
    AnyFault,
    Bursts,
    Freeze,
    IdentityErrors,
    Kill,
    LastingFault,
    Latency,
    Loss,
    Partition,
    Reboot,
    Silence,
)  # fmt: skip

NOBODY: frozenset[int] = frozenset()
_SLACK_TICKS = 1e-6  # 0.3 s are three ticks of 0.1 s


@dataclass(frozen=True, slots=True, kw_only=True)
class Ills:
    """All that is wrong in a tick.

    Attributes:
        dead, frozen: agents whose computer is out, or stands still: nobody waits for them.
        links: what is wrong with the radio. identity_errors: by uid, where targets are mistaken more often than usual.
        breakage: by uid, the SIM_* parameters of what is broken in its vehicle.
    """

    dead: frozenset[int] = NOBODY
    frozen: frozenset[int] = NOBODY
    links: Disturbance = CALM
    identity_errors: Mapping[int, float] = field(default_factory=dict)
    breakage: Mapping[int, dict[str, float]] = field(default_factory=dict)

    def stopped(self, uid: int) -> bool:
        """Whether nobody need wait for agent `uid`."""
        return uid in self.dead or uid in self.frozen


WELL = Ills()


@dataclass(frozen=True, slots=True)
class Spell:
    """One fault on the mission's ticks: from `first` on, and before `end` (None: to the end of everything)."""

    fault: AnyFault
    first: int
    end: int | None

    def holds(self, tick: int) -> bool:
        """Whether it is there at that tick."""
        return self.first <= tick and (self.end is None or tick < self.end)

    def over_at(self, tick: int | None) -> bool:
        """Whether it lasted, and is right again from this tick on."""
        return tick is not None and tick == self.end and isinstance(self.fault, LastingFault)


class Schedule:
    """A mission's faults in time. Ticks count from the beginning of MISSION, and go on when it has ended.

    Attributes:
        spells: every fault, in the order of the mission.
    """

    def __init__(self, mission: Mission) -> None:
        self.spells = spells_of(mission.faults, mission.tick_s)
        edges = {edge for spell in self.spells for edge in (spell.first, spell.end) if edge is not None}
        self._edges = sorted(edges)
        self._reboots = {(uid, s.first) for s in self.spells if isinstance(s.fault, Reboot) for uid in s.fault.agents}
        self._ills = [WELL, *(self._all_at(edge, mission) for edge in self._edges)]

    def at(self, tick: int | None) -> Ills:
        """What is wrong at a tick; before the mission (None) nothing is."""
        return WELL if tick is None else self._ills[bisect_right(self._edges, tick)]

    def news(self, tick: int | None) -> tuple[Event, ...]:
        """What begins and ends at this tick, in words."""
        begun = [f"fault: {words(spell.fault)}" for spell in self.spells if spell.first == tick]
        over = [f"over: {words(spell.fault)}" for spell in self.spells if spell.over_at(tick)]
        return tuple([Event(Level.WARNING, text) for text in begun] + [Event(Level.INFO, text) for text in over])

    def reboots(self, uid: int, tick: int, *, since: int) -> bool:
        """Whether the autopilot of agent `uid` loses its power at this tick, or at a skipped one after `since`."""
        return any((uid, passed) in self._reboots for passed in range(since + 1, tick + 1))

    def comes_back(self, uid: int, tick: int) -> bool:
        """Whether a computer that is out, or stands still, at this tick ever goes on."""
        stops = [s for s in self.spells if isinstance(s.fault, Kill | Freeze) and uid in s.fault.agents]
        return all(spell.end is not None for spell in stops if spell.holds(tick))

    def _all_at(self, tick: int, mission: Mission) -> Ills:
        holding = [spell for spell in self.spells if spell.holds(tick)]
        faults = [spell.fault for spell in holding]
        dead = {uid for fault in faults if isinstance(fault, Kill) for uid in fault.agents}
        frozen = {uid for fault in faults if isinstance(fault, Freeze) for uid in fault.agents}
        return Ills(
            dead=frozenset(dead),
            frozen=frozenset(frozen - dead),
            links=_links(faults, mission.tick_s),
            identity_errors=_identity_errors(faults, mission),
            breakage=_breakage(holding, mission),
        )


def spells_of(faults: Sequence[AnyFault], tick_s: float) -> tuple[Spell, ...]:
    """The faults on the ticks of a mission."""
    return tuple(_spell(fault, tick_s) for fault in faults)


def _spell(fault: AnyFault, tick_s: float) -> Spell:
    first = _ticks(fault.at_s, tick_s)
    if isinstance(fault, Reboot):
        return Spell(fault, first, first + 1)
    if not isinstance(fault, LastingFault) or fault.for_s is None:
        return Spell(fault, first, None)
    return Spell(fault, first, max(first + 1, _ticks(fault.at_s + fault.for_s, tick_s)))


def _ticks(time_s: float, tick_s: float) -> int:
    """The first tick at or after this time."""
    return ceil(time_s / tick_s - _SLACK_TICKS)


def _links(faults: Sequence[AnyFault], tick_s: float) -> Disturbance:
    def whom(uids: tuple[int, ...] | None) -> frozenset[int] | None:
        return None if uids is None else frozenset(uids)

    links = Disturbance(
        silent=frozenset(uid for fault in faults if isinstance(fault, Silence) for uid in fault.agents),
        partitions=tuple(
            {uid: number for number, group in enumerate(fault.groups) for uid in group}
            for fault in faults
            if isinstance(fault, Partition)
        ),
        loss=tuple(Trouble(fault.share, whom(fault.agents)) for fault in faults if isinstance(fault, Loss)),
        bursts=tuple(
            Trouble(fault.share, whom(fault.agents), max(1, _ticks(fault.burst_s, tick_s)))
            for fault in faults
            if isinstance(fault, Bursts)
        ),
        latency=tuple(Trouble(fault.latency_s, whom(fault.agents)) for fault in faults if isinstance(fault, Latency)),
    )
    return CALM if links == CALM else links


def _identity_errors(faults: Sequence[AnyFault], mission: Mission) -> dict[int, float]:
    usual = mission.agents.sensing.identity_error
    errors: dict[int, float] = {}
    for fault in faults:
        if isinstance(fault, IdentityErrors):
            for uid in _uids(fault, mission):
                errors[uid] = max(errors.get(uid, usual), fault.identity_error)
    return errors


def _breakage(holding: Sequence[Spell], mission: Mission) -> dict[int, dict[str, float]]:
    """Of two faults that set one parameter, the one that began later holds, wherever the mission lists it."""
    breakage: dict[int, dict[str, float]] = {}
    for fault in (spell.fault for spell in sorted(holding, key=lambda spell: spell.first)):
        if isinstance(fault, VEHICLE_FAULTS):
            for uid in _uids(fault, mission):
                breakage.setdefault(uid, {}).update(broken(fault, mission))
    return breakage


def _uids(fault: AnyFault, mission: Mission) -> Sequence[int]:
    return range(mission.agents.count) if fault.agents is None else fault.agents
