"""What a mission would run, as a value and as tables: who flies where, over what, for how long, with every setting."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, prod
from typing import TYPE_CHECKING, Any

from comms.arena import area_m2
from comms.frames import GeoPoint, Vec3, geo_from_enu
from missions.faults.words import lasting, whom
from missions.mission import Mission, MovingTargets
from missions.observation import Phase
from missions.problems import shown
from missions.rules import start_places

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table


@dataclass(frozen=True, slots=True)
class AgentPlan:
    """One agent: its number, its MAVLink system id, where it starts, and how high it flies.

    `start_m` is its layer above its starting place (ENU); `home` is that place on the ground. A vehicle behind a `link`
    tells its system id if that is None, and starts where it stands.
    """

    uid: int
    system_id: int | None
    link: str | None
    start_m: Vec3
    home: GeoPoint


@dataclass(frozen=True, slots=True)
class PhasePlan:
    """One phase of the mission, and how long it takes: for PREPARE and RETURN at least."""

    phase: Phase
    what: str
    duration_s: float


@dataclass(frozen=True, slots=True)
class Plan:
    """All that a mission would run. `coverage_floor` is the coverage of static agents at random places."""

    mission: Mission
    agents: tuple[AgentPlan, ...]
    phases: tuple[PhasePlan, ...]
    coverage_floor: float


def plan_mission(mission: Mission) -> Plan:
    """The plan of a loaded mission; the same mission gives the same plan."""
    return Plan(mission, _agents(mission), _phases(mission), coverage_floor(mission))


def coverage_floor(mission: Mission) -> float:
    """Share of the arena that agents at random places would see: 1 - (1 - A_sensed / A_arena)^m."""
    sensing, arena_m2 = mission.agents.sensing, area_m2(mission.arena.area)
    share = sensing.opening_deg / 360 if sensing.field_of_view == "sector" else 1.0
    return 1 - prod(1 - min(1.0, share * pi * range_m**2 / arena_m2) for range_m in mission.agents.sensing_ranges_m)


def _agents(mission: Mission) -> tuple[AgentPlan, ...]:
    places = start_places(mission)
    assert places is not None, "a mission whose agents do not fit is no loaded mission"
    altitude, home = mission.agents.altitude, mission.home.place
    return tuple(
        AgentPlan(
            uid,
            mission.system_id(uid),
            mission.link(uid),
            (x, y, altitude.of_agent(uid)),
            geo_from_enu(home, (x, y, 0.0)),
        )
        for uid, (x, y) in enumerate(places)
    )


def _phases(mission: Mission) -> tuple[PhasePlan, ...]:
    vehicle, altitude = mission.vehicle, mission.agents.altitude
    top_m = max(altitude.of_agent(uid) for uid in range(mission.agents.count))
    climb_s = vehicle.boot_s + top_m / vehicle.limits.climb_m_s
    ticks = f"{round(mission.duration_s / mission.tick_s)} ticks of {shown(mission.tick_s)} s"
    return (
        PhasePlan(Phase.PREPARE, f"connect, preflight, takeoff to the top layer at {shown(top_m)} m", climb_s),
        PhasePlan(Phase.MISSION, f"targets move, coverage counts; {ticks}", mission.duration_s),
        PhasePlan(Phase.RETURN, "return, land, disarm", top_m / vehicle.limits.descent_m_s),
    )


def print_plan(plan: Plan, console: Console) -> None:
    """The plan as tables a person reads: summary, agents, phases, and every setting beside its default."""
    mission = plan.mission
    console.print(mission.name, style="bold")
    if mission.description:
        console.print(mission.description)
    console.print(_summary(plan))
    tables = [_agent_table(plan), _phase_table(plan)]
    if mission.faults:
        tables.append(_fault_table(mission))
    for table in (*tables, _setting_table(mission)):
        console.print()
        console.print(table)


def _summary(plan: Plan) -> str:
    mission, targets = plan.mission, plan.mission.targets
    if isinstance(targets, MovingTargets):
        watched = f"{targets.count} {targets.motion} targets"
    else:
        watched = f"the tracks in {targets.file.name}"
    return (
        f"{mission.agents.count} agents over {watched}, {mission.policy.name}, seed {mission.seed}. "
        f"Coverage floor (static agents at random places): {plan.coverage_floor:.1%}"
    )


def _table(title: str, *columns: str, numbers: tuple[str, ...] = ()) -> Table:
    from rich.table import Table

    table = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False)
    for column in columns:
        table.add_column(column, justify="right" if column in numbers else "left")
    return table


def _agent_table(plan: Plan) -> Table:
    columns = ("uid", "system id", "altitude m", "start east m", "start north m", "home latitude", "home longitude")
    table = _table("Agents", *columns, numbers=columns)
    for agent in plan.agents:
        table.add_row(str(agent.uid), str(agent.system_id or "it tells"), shown(agent.start_m[2]), *_start(agent))
    return table


def _start(agent: AgentPlan) -> tuple[str, str, str, str]:
    """Where it starts, as the table's last columns; what is known of a vehicle elsewhere is how it is reached."""
    if agent.link is not None:
        return ("where", "it stands", agent.link, "")
    east, north, _ = agent.start_m
    return (f"{east:.2f}", f"{north:.2f}", f"{agent.home.latitude_deg:.7f}", f"{agent.home.longitude_deg:.7f}")


def _phase_table(plan: Plan) -> Table:
    table = _table("Phases", "phase", "seconds", "what", numbers=("seconds",))
    for phase in plan.phases:
        about = "" if phase.phase is Phase.MISSION else "at least "
        table.add_row(phase.phase, f"{about}{phase.duration_s:.0f}", phase.what)
    return table


def _fault_table(mission: Mission) -> Table:
    table = _table("Faults", "at s", "for s", "what", "whom", numbers=("at s", "for s"))
    for fault in sorted(mission.faults, key=lambda fault: fault.at_s):
        table.add_row(shown(fault.at_s), lasting(fault), fault.what, whom(fault))
    return table


def _setting_table(mission: Mission) -> Table:
    table = _table("Settings", "key", "value", "default, where it differs")
    defaults = _settings(Mission(name=mission.name).model_dump(mode="json"))
    for key, value in _settings(mission.model_dump(mode="json")).items():
        default = defaults.get(key, value)
        table.add_row(key, _setting(value), "" if value == default else _setting(default))
    return table


def _setting(value: Any) -> str:
    return value if isinstance(value, str) else "none" if value == [] else shown(value)


def _settings(section: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Every value by its dotted key."""
    flat: dict[str, Any] = {}
    for key, value in section.items():
        flat |= _settings(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return flat
