"""Observations as they are put together again, tick by tick, from the files of a recording.

Back come the values that metrics are counted from, exactly; places as they are drawn (to 1/64 m), velocities as their
differences, links and batteries as of the last full second. What an agent estimates of itself is not recorded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from heapq import merge
from math import atan2
from operator import is_, itemgetter
from typing import Any, TypeVar

import numpy as np
import pyarrow as pa

from comms.status import Activity, AgentStatus, Event, HelpCallStatus, Level
from missions.coverage import Coverage
from missions.observation import AgentTruth, Observation, Phase, TargetTruth, Totals
from missions.recording import ledger
from missions.recording.charts import UNKNOWN
from missions.recording.latest import Latest, Upcoming
from missions.recording.scene import agent_names
from missions.recording.table import Floats, Table
from missions.report import Facts

# The entities that observations are made of.
PATHS = (
    "/__properties/**",
    "/ledger/**",
    "/log/**",
    "/agents/**",
    "/world/agents/body",
    "/world/agents/heading",
    "/world/targets/body",
    "/telemetry/tick_late",
    "/telemetry/battery",
    "/radio/graph",
)
_LEVELS = {"INFO": Level.INFO, "WARN": Level.WARNING, "ERROR": Level.ERROR}
_TEXT, _WHOLE, _REAL = pa.string(), pa.int64(), pa.float64()
_EDGE = pa.struct([pa.field("first", _TEXT, nullable=False), pa.field("second", _TEXT, nullable=False)])
_MISSION = "mission"
_ABSENT = TargetTruth(0.0, 0.0, present=False, seen=False)

T = TypeVar("T")
Links = tuple[tuple[int, int], ...]
# Rows of an entity's components, each made a value.
Read = Callable[[str, dict[str, pa.DataType], Callable[..., Any]], Iterator[tuple[int, Any]]]


class Reel:
    """Files go in one after the other, and observations come out.

    Attributes:
        damaged: what was left out because it makes no sense: chunks, and rows.
    """

    def __init__(self, facts: Facts) -> None:
        n_agents, n_targets = facts.agents, facts.targets
        self._facts = facts
        self._uids = {name: uid for uid, name in enumerate(agent_names(n_agents))}
        self._phase = Latest((Phase.PREPARE, ledger.NOBODY))
        self._late_s = Latest(0.0)
        self._duties = Latest(((ledger.NOBODY, ""),) * n_agents)
        self._batteries = Latest[Sequence[float | None]]((None,) * n_agents)
        self._tags = Latest[Sequence[tuple[int, ...]]](((),) * n_agents)
        self._calls = Latest[Sequence[tuple[HelpCallStatus, ...]]](((),) * n_agents)
        self._activities = Upcoming[tuple[int, Activity]]()
        self._words = Upcoming[tuple[int | None, Event]]()
        self._places_m = Latest(np.zeros((n_agents, 3), np.float32))
        self._arrows = Latest(np.zeros((n_agents, 3), np.float32))
        self._targets = Latest(((False, False),) * n_targets)
        self._targets_m = Latest(np.zeros((0, 3), np.float32))
        self._links = Latest[Links](())
        self._doing = [Activity.PREPARING] * n_agents
        self._before: tuple[Sequence[Any], tuple[AgentStatus, ...]] = ((), ())  # from which values, which statuses
        self._last: tuple[int, Floats] | None = None
        self._coverage = Coverage()
        self.damaged = 0

    def play(self, table: Table) -> Iterator[Observation]:
        """The ticks of the next file."""
        read = partial(self._read, table)
        self._add_states(read)
        self._add_activities(read)
        self._add_words(read)
        self._add_places(table)
        # The ledger is written last: whatever has its totals is whole.
        for tick, totals in read(ledger.TOTALS, {"total": _WHOLE}, _totals):
            if self._last is None or tick > self._last[0]:
                yield self._observation(tick, totals)
        self.damaged += table.damaged

    def _add_states(self, read: Read) -> None:
        """What holds until it changes, of all agents or targets at once."""
        n_agents, n_targets = self._facts.agents, self._facts.targets
        pairs = {"agent": _WHOLE, "target": _WHOLE}
        scalars = {"Scalars:scalars": _REAL}
        self._phase.add(read(ledger.PHASE, {"phase": _TEXT, "mission_began_at": _WHOLE}, _phase))
        self._late_s.add(read("/telemetry/tick_late", scalars, lambda row: float(row[0])))
        self._batteries.add(read("/telemetry/battery", scalars, lambda row: _as_many(_known(row), n_agents)))
        self._duties.add(
            read(
                ledger.DUTIES,
                {"helping": _WHOLE, "flight_mode": _TEXT},
                lambda *rows: _as_many(list(zip(*rows, strict=True)), n_agents),
            )
        )
        self._tags.add(read(ledger.TAGS, pairs, partial(self._by_agent, int)))
        calls = {**pairs, "loss_in_s": _REAL, "urgent": _WHOLE}
        self._calls.add(read(ledger.CALLS, calls, partial(self._by_agent, _call)))
        self._targets.add(
            read(
                ledger.TARGETS,
                {"present": _WHOLE, "seen": _WHOLE},
                lambda *rows: _as_many(_flags(*rows), n_targets),
            )
        )
        self._links.add(read("/radio/graph", {"GraphEdges:edges": _EDGE}, self._heard))

    def _add_activities(self, read: Read) -> None:
        lanes = (
            read(f"/agents/{name}/mode", {"StateChange:state": _TEXT}, lambda row, uid=uid: (uid, Activity(row[0])))
            for name, uid in self._uids.items()
        )
        self._activities.add(merge(*lanes, key=itemgetter(0)))

    def _add_words(self, read: Read) -> None:
        speakers: dict[str, int | None] = {_MISSION: None, **self._uids}
        words = (
            read(
                f"/log/{name}",
                {"TextLog:text": _TEXT, "TextLog:level": _TEXT},
                lambda texts, levels, name=name, uid=uid: (uid, _event(name, texts, levels)),
            )
            for name, uid in speakers.items()
        )
        self._words.add(merge(*words, key=itemgetter(0)))

    def _add_places(self, table: Table) -> None:
        n_agents = self._facts.agents
        self._places_m.add(self._points(table, "/world/agents/body", "Points3D:positions", n_agents))
        self._arrows.add(self._points(table, "/world/agents/heading", "Arrows3D:vectors", n_agents))
        self._targets_m.add(self._points(table, "/world/targets/body", "Points3D:positions", None))

    def _read(
        self, table: Table, path: str, components: dict[str, pa.DataType], value: Callable[..., T]
    ) -> Iterator[tuple[int, T]]:
        """Rows as values; a row of which none can be made is damaged."""
        for tick, row in table.rows(path, components):
            try:
                made = value(*row)
            except (LookupError, ValueError, TypeError):
                self.damaged += 1
            else:
                yield tick, made

    def _points(self, table: Table, path: str, component: str, count: int | None) -> Iterator[tuple[int, Floats]]:
        for tick, points in table.points(path, component):
            if np.isfinite(points).all() and count in (None, len(points)):
                yield tick, points
            else:
                self.damaged += 1

    def _by_agent(self, entry: Callable[..., T], uids: list[int], *columns: list[Any]) -> tuple[tuple[T, ...], ...]:
        """For each agent its entries, which are about targets first of all."""
        own: list[list[T]] = [[] for _ in range(self._facts.agents)]
        for uid, target, *more in zip(uids, *columns, strict=True):
            if not (0 <= uid < self._facts.agents and 0 <= target < self._facts.targets):
                raise ValueError(f"agent {uid} or target {target}")
            own[uid].append(entry(target, *more))
        return tuple(map(tuple, own))

    def _heard(self, edges: list[dict[str, str]]) -> Links:
        pairs = ((edge["first"], edge["second"]) for edge in edges)
        return tuple((self._uids[a], self._uids[b]) for a, b in pairs if {a, b} <= self._uids.keys())

    def _observation(self, tick: int, totals: Totals) -> Observation:
        facts = self._facts
        phase, began = self._phase.at(tick)
        on_duty = phase is Phase.MISSION
        words: dict[int | None, tuple[Event, ...]] = {}
        for uid, event in self._words.until(tick):
            words[uid] = (*words.get(uid, ()), event)
        targets = self._targets_at(tick)
        if on_duty:
            self._coverage.add(
                seen=sum(target.seen for target in targets), present=sum(target.present for target in targets)
            )
        mean = self._coverage.mean if on_duty else None
        return Observation(
            tick=tick,
            time_s=tick * facts.tick_s,
            phase=phase,
            mission_tick=tick - began if on_duty else None,
            statuses=self._statuses_at(tick, words),
            truths=self._truths_at(tick),
            targets=targets,
            links=self._links.at(tick),
            coverage=self._coverage.now if on_duty else None,
            coverage_mean=mean,
            utilization=None if mean is None else mean * facts.targets / facts.agents,
            tick_late_s=self._late_s.at(tick),
            totals=totals,
            events=words.get(None, ()),
        )

    def _statuses_at(self, tick: int, words: dict[int | None, tuple[Event, ...]]) -> tuple[AgentStatus, ...]:
        for uid, activity in self._activities.until(tick):
            if self._doing[uid] is not activity:
                self._doing = [*self._doing]
                self._doing[uid] = activity
        values = (self._doing, *(one.at(tick) for one in (self._batteries, self._tags, self._calls, self._duties)))
        were, statuses = self._before
        if words or len(were) != len(values) or not all(map(is_, values, were)):
            statuses = tuple(
                AgentStatus(
                    uid=uid,
                    activity=activity,
                    battery=battery,
                    tags=tags,
                    calls=calls,
                    helping=None if helping == ledger.NOBODY else helping,
                    flight_mode=flight_mode,
                    events=words.get(uid, ()),
                )
                for uid, (activity, battery, tags, calls, (helping, flight_mode)) in enumerate(
                    zip(*values, strict=True)
                )
            )
            self._before = (() if words else values), statuses
        return statuses

    def _truths_at(self, tick: int) -> tuple[AgentTruth, ...]:
        places_m = self._places_m.at(tick)
        before_tick, before_m = self._last or (tick, places_m)
        moved_s = (tick - before_tick) * self._facts.tick_s
        moved_m = places_m.astype(np.float64) - before_m
        velocities = (moved_m / moved_s if moved_s else moved_m).tolist()
        self._last = tick, places_m
        return tuple(
            AgentTruth((x, y, z), (v_x, v_y, v_z), atan2(east, north))
            for (x, y, z), (v_x, v_y, v_z), (east, north, _) in zip(
                places_m.tolist(), velocities, self._arrows.at(tick).tolist(), strict=True
            )
        )

    def _targets_at(self, tick: int) -> tuple[TargetTruth, ...]:
        # Who is there has a place; if the row that says where is damaged, who has none is not.
        places_m = iter(self._targets_m.at(tick).tolist())
        return tuple(
            TargetTruth(place[0], place[1], present=True, seen=seen)
            if here and (place := next(places_m, None))
            else _ABSENT
            for here, seen in self._targets.at(tick)
        )


def _as_many(row: Sequence[T], count: int) -> tuple[T, ...]:
    if len(row) != count:
        raise ValueError(f"{len(row)} entries")
    return tuple(row)


def _flags(*rows: Iterable[int]) -> list[tuple[bool, ...]]:
    return [tuple(map(bool, entry)) for entry in zip(*rows, strict=True)]


def _totals(row: list[int]) -> Totals:
    return Totals(**dict(zip(ledger.TOTAL_NAMES, row, strict=False)))  # older ones have fewer


def _phase(phases: list[str], began: list[int]) -> tuple[Phase, int]:
    return Phase(phases[0]), began[0]


def _known(row: list[float]) -> list[float | None]:
    return [None if value == UNKNOWN else value for value in row]


def _call(target: int, loss_in_s: float, urgent: int) -> HelpCallStatus:
    return HelpCallStatus(target, loss_in_s, bool(urgent))


def _event(speaker: str, texts: list[str], levels: list[str]) -> Event:
    return Event(_LEVELS[levels[0]], texts[0].removeprefix(f"{speaker}  "))
