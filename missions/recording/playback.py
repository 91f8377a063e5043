"""A recording read back: what was observed at every tick, and what was flown.

    playback = play_back(Path("flight.rrd"))
    for observation in playback.observations:
        metrics.observe(observation)    # counts what it counted in flight

Back come the values that metrics are counted from, exactly; places as they are drawn (to 1/64 m), velocities as their
differences, links and batteries as of the last full second. What an agent estimates of itself is not in the ledger.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import atan2
from pathlib import Path
from typing import Any

import numpy as np
from rerun.chunk import RrdReader

from comms.status import Activity, AgentStatus, Event, HelpCallStatus, Level
from missions.observation import AgentTruth, Observation, Phase, TargetTruth, Totals
from missions.problems import InputError
from missions.recording import ledger
from missions.recording.charts import UNKNOWN
from missions.recording.scene import agent_names
from missions.recording.table import Table, held
from missions.recording.whole import whole
from missions.report import PACKAGES, Facts

_LEVELS = {"INFO": Level.INFO, "WARN": Level.WARNING, "ERROR": Level.ERROR}
# The entities that are read.
READ = (
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
    "/knowledge/**",
)
_NOT_OURS = "a recording that swarm launch --record wrote"


@dataclass(frozen=True, slots=True, kw_only=True)
class Playback:
    """What a recording holds.

    Attributes:
        facts: what flew. mission_yaml: the whole mission, every key written out.
        observations: in the order of ticks. ticks_missing: ticks before the last that are not there.
        pages: what an agent knew, wanted and why, as Markdown: by uid, pairs of tick and page, in order.
        torn: the recording was never finished; it was repaired to be read.
    """

    path: Path
    facts: Facts
    mission_yaml: str
    observations: Sequence[Observation]
    pages: Mapping[int, Sequence[tuple[int, str]]]
    ticks_missing: int
    torn: bool


def play_back(path: Path) -> Playback:
    """Read a recording, all parts of it, or a `.rrd.part` of one whose recorder was killed.

    Raises:
        InputError: there is no such file, or it is no recording of a mission.
    """
    with whole(path) as (files, torn):
        try:
            table = Table([RrdReader(file) for file in files], READ)
        except (RuntimeError, ValueError) as error:
            raise InputError(f"{path}: got no recording ({_first_line(error)}); allowed: {_NOT_OURS}") from error
    try:
        return _played(path, table, torn=torn)
    except (LookupError, ValueError, TypeError) as error:
        raise InputError(f"{path}: got a recording without {error}; allowed: {_NOT_OURS}, of this version") from error


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [""])[0]


def _played(path: Path, table: Table, *, torn: bool) -> Playback:
    mission, versions = table.statics("/__properties/mission"), table.statics("/__properties/versions")
    floor = mission.get("coverage_floor")
    facts = Facts(
        mission=mission["name"],
        policy=mission["policy"],
        seed=mission["seed"],
        agents=mission["agents"],
        targets=mission["targets"],
        tick_s=mission["tick_s"],
        coverage_floor=floor,
        versions={name: versions[name] for name in ("python", *PACKAGES) if name in versions},
    )
    observations = _observations(table, facts)
    if not observations:
        raise LookupError("a single tick")
    ticks = [seen.tick for seen in observations]
    return Playback(
        path=path,
        facts=facts,
        mission_yaml=mission["yaml"],
        observations=observations,
        ticks_missing=ticks[-1] + 1 - len(ticks),
        pages={uid: _pages(table, name) for uid, name in enumerate(agent_names(facts.agents))},
        torn=torn,
    )


def _observations(table: Table, facts: Facts) -> list[Observation]:
    # The ledger is written last: whatever has its totals is whole.
    ticks, totals = table.rows(ledger.TOTALS, "total")
    late = table.held("/telemetry/tick_late", "Scalars:scalars", ticks, [0.0])
    phases = table.held(ledger.PHASE, "phase", ticks, [Phase.PREPARE.value])
    began = table.held(ledger.PHASE, "mission_began_at", ticks, [ledger.NOBODY])
    statuses = _statuses(table, ticks, facts)
    truths = _truths(table, ticks, facts)
    targets = _targets(table, ticks, facts.targets)
    links = _links(table, ticks, facts.agents)
    said = _said(table, "mission")
    seen_so_far = present_so_far = 0
    observations = []
    for row, tick in enumerate(ticks):
        on_duty = phases[row][0] == Phase.MISSION.value
        seen, present = (sum(getattr(target, name) for target in targets[row]) for name in ("seen", "present"))
        if on_duty:
            seen_so_far, present_so_far = seen_so_far + seen, present_so_far + present
        mean = seen_so_far / present_so_far if on_duty and present_so_far else None
        observations.append(
            Observation(
                tick=tick,
                time_s=tick * facts.tick_s,
                phase=Phase(phases[row][0]),
                mission_tick=tick - began[row][0] if on_duty else None,
                statuses=statuses[row],
                truths=truths[row],
                targets=targets[row],
                links=links[row],
                coverage=seen / present if on_duty and present else None,
                coverage_mean=mean,
                utilization=None if mean is None else mean * facts.targets / facts.agents,
                tick_late_s=late[row][0],
                totals=Totals(**dict(zip(ledger.TOTAL_NAMES, totals[row], strict=False))),  # older ones have fewer
                events=said.get(tick, ()),
            )
        )
    return observations


def _statuses(table: Table, ticks: Sequence[int], facts: Facts) -> list[tuple[AgentStatus, ...]]:
    n_agents = facts.agents
    names = agent_names(n_agents)
    helping = table.held(ledger.DUTIES, "helping", ticks, [ledger.NOBODY] * n_agents)
    modes = table.held(ledger.DUTIES, "flight_mode", ticks, [""] * n_agents)
    batteries = table.held("/telemetry/battery", "Scalars:scalars", ticks, [UNKNOWN] * n_agents)
    tags = _per_agent(table, ledger.TAGS, ("target",), ticks, n_agents)
    calls = _per_agent(table, ledger.CALLS, ("target", "loss_in_s", "urgent"), ticks, n_agents)
    activities = [table.held(f"/agents/{name}/mode", "StateChange:state", ticks, ["preparing"]) for name in names]
    said = [_said(table, name) for name in names]
    return [
        tuple(
            AgentStatus(
                uid=uid,
                activity=Activity(activities[uid][row][0]),
                battery=None if batteries[row][uid] == UNKNOWN else batteries[row][uid],
                tags=tuple(target for (target,) in tags[row][uid]),
                calls=tuple(HelpCallStatus(target, loss_s, bool(urgent)) for target, loss_s, urgent in calls[row][uid]),
                helping=None if helping[row][uid] == ledger.NOBODY else helping[row][uid],
                flight_mode=modes[row][uid],
                events=said[uid].get(tick, ()),
            )
            for uid in range(n_agents)
        )
        for row, tick in enumerate(ticks)
    ]


def _per_agent(
    table: Table, path: str, names: Sequence[str], ticks: Sequence[int], n_agents: int
) -> list[Sequence[Sequence[tuple[Any, ...]]]]:
    """For every tick and agent, the entries of `path` that are that agent's."""
    at, agents = table.rows(path, "agent")
    columns = [table.rows(path, name)[1] for name in names]
    rows: list[Sequence[Sequence[tuple[Any, ...]]]] = []
    for row, uids in enumerate(agents):
        own: list[list[tuple[Any, ...]]] = [[] for _ in range(n_agents)]
        for uid, *entry in zip(uids, *(column[row] for column in columns), strict=True):
            own[uid].append(tuple(entry))
        rows.append(own)
    return held(at, rows, ticks, [()] * n_agents)


def _truths(table: Table, ticks: Sequence[int], facts: Facts) -> list[tuple[AgentTruth, ...]]:
    places = table.places("/world/agents/body", "Points3D:positions", ticks, facts.agents)
    arrows = table.places("/world/agents/heading", "Arrows3D:vectors", ticks, facts.agents)
    moved_s = np.diff(ticks, prepend=ticks[:1])[:, None, None] * facts.tick_s
    moved_m = np.diff(places, axis=0, prepend=places[:1])
    velocities = np.divide(moved_m, moved_s, out=np.zeros_like(moved_m), where=moved_s > 0)
    return [
        tuple(
            AgentTruth(tuple(place), tuple(velocity), atan2(arrow[0], arrow[1]))
            for place, velocity, arrow in zip(*row, strict=True)
        )
        for row in zip(places.tolist(), velocities.tolist(), arrows.tolist(), strict=True)
    ]


def _targets(table: Table, ticks: Sequence[int], n_targets: int) -> list[tuple[TargetTruth, ...]]:
    present = table.held(ledger.TARGETS, "present", ticks, [0] * n_targets)
    seen = table.held(ledger.TARGETS, "seen", ticks, [0] * n_targets)
    places = table.held("/world/targets/body", "Points3D:positions", ticks, [])
    absent = TargetTruth(0.0, 0.0, present=False, seen=False)
    rows = []
    for here, looked_at, spots in zip(present, seen, places, strict=True):
        spot = iter(spots)
        rows.append(
            tuple(
                _target(next(spot), seen=bool(eye)) if there else absent
                for there, eye in zip(here, looked_at, strict=True)
            )
        )
    return rows


def _target(place_m: Sequence[float], *, seen: bool) -> TargetTruth:
    x, y, _ = place_m
    return TargetTruth(x, y, present=True, seen=seen)


def _links(table: Table, ticks: Sequence[int], n_agents: int) -> list[tuple[tuple[int, int], ...]]:
    uids = {name: uid for uid, name in enumerate(agent_names(n_agents))}
    at, edges = table.rows("/radio/graph", "GraphEdges:edges")
    links = [
        tuple((uids[edge["first"]], uids[edge["second"]]) for edge in row if {*edge.values()} <= uids.keys())
        for row in edges
    ]
    return held(at, links, ticks, ())


def _said(table: Table, speaker: str) -> dict[int, tuple[Event, ...]]:
    """What a speaker said, by tick."""
    path, said = f"/log/{speaker}", dict[int, tuple[Event, ...]]()
    at, texts = table.rows(path, "TextLog:text")
    _, levels = table.rows(path, "TextLog:level")
    for tick, (text,), (level,) in zip(at, texts, levels, strict=True):
        event = Event(_LEVELS[level], text.removeprefix(f"{speaker}  "))
        said[tick] = (*said.get(tick, ()), event)
    return said


def _pages(table: Table, speaker: str) -> list[tuple[int, str]]:
    at, texts = table.rows(f"/knowledge/{speaker}", "TextDocument:text")
    return [(tick, text) for tick, (text,) in zip(at, texts, strict=True)]
