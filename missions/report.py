"""The report of a mission: stable keys, as JSON and as a table. README documents them.

Two runs of one mission with one seed differ in `timing` and `recording` alone.
"""

from __future__ import annotations

import json
import platform
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from missions.metrics import Metrics
from missions.plan import coverage_floor
from missions.problems import InputError

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from missions.sides.world import WorldSide

Report = dict[str, Any]

PACKAGES = ("swarm-mission-stack", "eclipse-zenoh", "pymavlink")
_DIGITS = 6
_FAULTS_SHOWN = 10


@dataclass(frozen=True, slots=True, kw_only=True)
class Facts:
    """What a report says of a mission before anything has happened in it."""

    mission: str
    policy: str
    seed: int
    agents: int
    targets: int
    tick_s: float
    coverage_floor: float | None
    versions: Mapping[str, str]


def make_report(side: WorldSide, metrics: Metrics, *, wall_s: float, recording: Path | None) -> Report:
    """Everything worth keeping of a flight that has ended."""
    mission = side.mission
    facts = Facts(
        mission=mission.name,
        policy=mission.policy.name,
        seed=mission.seed,
        agents=mission.agents.count,
        targets=len(side.world.places),
        tick_s=mission.tick_s,
        coverage_floor=coverage_floor(mission),
        versions=versions(PACKAGES),
    )
    return report_of(facts, metrics, wall_s=wall_s, clock_s=side.clock_s, recording=recording)


def report_of(
    facts: Facts, metrics: Metrics, *, wall_s: float | None, clock_s: float, recording: Path | None
) -> Report:
    """The report of a mission that was observed, in flight or in its recording.

    Args:
        wall_s: how long it took; None when nobody knows. clock_s: the mission clock at its end.
    """
    coverage, totals = metrics.coverage.mean, metrics.totals
    return {
        "mission": facts.mission,
        "policy": facts.policy,
        "seed": facts.seed,
        "agents": facts.agents,
        "targets": facts.targets,
        "duration_s": _rounded(metrics.ticks * facts.tick_s),
        "coverage": _rounded(coverage),
        "coverage_late": _rounded(metrics.coverage.late),
        "coverage_floor": _rounded(facts.coverage_floor),
        "utilization": None if coverage is None else _rounded(coverage * facts.targets / facts.agents),
        "events": asdict(metrics.events),
        "help": asdict(metrics.help),
        "radio": {
            "sent": totals.radio_sent,
            "delivered": totals.radio_delivered,
            "out_of_range": totals.radio_out_of_range,
            "lost": totals.radio_lost,
            "refused": totals.radio_refused,
            "bytes": totals.radio_bytes,
        },
        "mavlink": {
            "sent": totals.mavlink_sent,
            "received": totals.mavlink_received,
            "bad": totals.mavlink_bad,
            "dropped": totals.mavlink_dropped,
            "vehicles": {
                "received": totals.vehicles_received,
                "bad": totals.vehicles_bad,
                "dropped": totals.vehicles_dropped,
            },
        },
        "faults": [asdict(fault) for fault in metrics.faults],
        "injected": metrics.costs.told(metrics.coverage),
        "recording": None if recording is None else str(recording),
        "versions": dict(facts.versions),
        "timing": {
            "wall_s": None if wall_s is None else round(wall_s, 3),
            "realtime_factor": round(clock_s / wall_s, 2) if wall_s else None,
            "tick_late_s_max": round(metrics.tick_late_s_max, 4),
        },
    }


def versions(packages: tuple[str, ...]) -> dict[str, str]:
    """Which software flew: Python and `packages`, by name."""
    found = {"python": platform.python_version()}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:  # run from a source tree that is not installed
            found[package] = "unknown"
    return found


def check_files(*, report: str | None, record: Path | None) -> None:
    """What cannot be written is found out before takeoff.

    Raises:
        InputError: the report's file cannot, or is the recording's.
    """
    if report in (None, "-"):
        return
    path = Path(str(report))
    if record is not None and path.resolve() == record.resolve():
        raise InputError(f"--report: got {report}, where the recording goes; allowed: another file")
    try:
        if path.exists():
            path.open("a").close()
        else:
            path.touch()
            path.unlink()
    except OSError as error:
        raise InputError(f"--report: got {report}; allowed: a file that can be written ({error.strerror})") from error


def publish(report: Report, *, to: str | None, console: Console) -> None:
    """Write the report where it was asked for (`-`: standard output), and show it."""
    if to == "-":
        sys.stdout.write(as_json(report))
    elif to is not None:
        # Whole or not at all: a script that waits for the file must not find half of it.
        part = Path(f"{to}.part")
        part.write_text(as_json(report), encoding="utf-8")
        part.replace(to)
    console.print(as_table(report))


def as_json(report: Report) -> str:
    """The report as a JSON text with a final newline."""
    return json.dumps(report, indent=2) + "\n"


def as_table(report: Report) -> Table:
    """The report as a person wants it: one page, the important things first."""
    from rich.table import Table
    from rich.text import Text

    table = Table(
        title=f"{report['mission']}, seed {report['seed']}", title_style="bold", title_justify="left", box=None
    )
    table.add_column(style="dim")
    table.add_column()
    for name, text in (*_lines(report).items(), *_faults(report["faults"]), *_injected(report["injected"])):
        table.add_row(Text(name), Text(text))
    return table


def _lines(report: Report) -> Mapping[str, str]:
    events, helped, radio, mavlink, timing = (report[key] for key in ("events", "help", "radio", "mavlink", "timing"))
    lines = {
        "who": f"{report['agents']} agents, {report['targets']} targets, {report['policy']}, "
        f"{report['duration_s']:.0f} s of mission",
        "coverage": f"{_percent(report['coverage'])}   late {_percent(report['coverage_late'])}   "
        f"floor {_percent(report['coverage_floor'])}",
        "events": f"{events['target_loss']} losses, {events['target_discovery']} discoveries, "
        f"{events['tag_switch']} tag switches",
        "help": f"{helped['calls']} calls, {helped['answered']} answered, {helped['captured']} captured, "
        f"{helped['taken_over']} taken over; {helped['pursued']} own losses pursued, "
        f"{helped['found_again']} found again",
        "radio": f"{radio['sent']} frames sent, {radio['delivered']} delivered, {radio['out_of_range']} out of range, "
        f"{radio['lost']} lost, {radio['refused']} refused, {radio['bytes'] / 1e6:.1f} MB",
        "mavlink": f"{mavlink['sent']} sent, {mavlink['received']} received, {mavlink['bad']} bad, "
        f"{mavlink['dropped']} dropped",
    }
    if timing["wall_s"] is not None:
        lines["time"] = f"{timing['wall_s']:.1f} s, {timing['realtime_factor']} times real time from power-on to landed"
    if report["recording"]:
        lines["recording"] = report["recording"]
    return lines


def _faults(faults: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, str]]:
    """What should not have happened, a line each, as far as one looks at it."""
    for fault in faults[:_FAULTS_SHOWN]:
        who = "mission" if fault["agent"] is None else f"A{fault['agent']}"
        yield f"fault {fault['time_s']:.1f} s, {who}", fault["what"]
    if len(faults) > _FAULTS_SHOWN:
        yield "faults", f"and {len(faults) - _FAULTS_SHOWN} more: --report"


def _injected(faults: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, str]]:
    """Every fault of the mission's own, a line each."""
    for fault in faults:
        seen = ", ".join(f"{_percent(share)} {when}" for when, share in fault["coverage"].items())
        after_s = fault["noticed_after_s"]
        noticed = "not noticed" if after_s is None else f"noticed after {after_s:.1f} s by A{fault['noticed_by']}"
        yield f"at {fault['at_s']:g} s {fault['what']}, {fault['whom']}", f"{noticed}; coverage {seen}"


def _percent(share: float | None) -> str:
    return "none" if share is None else f"{share:.1%}"


def _rounded(number: float | None) -> float | None:
    return None if number is None else round(number, _DIGITS)
