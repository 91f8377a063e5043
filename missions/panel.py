"""A mission at a glance, for a terminal: how far, how much is seen, who does what, in the colors of the recording."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rich.console import Group, RenderableType
from rich.panel import Panel
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from comms.status import Activity
from missions.colors import ACTIVITY_COLORS, ACTIVITY_INKS, hex_color
from missions.observation import Phase

_BLOCKS = "▁▂▃▄▅▆▇█"
_BAR_COLUMNS = 40
_WIDTH = 84
_GOOD, _BAD, _WARN = (
    hex_color(ACTIVITY_INKS[activity]) for activity in (Activity.FOLLOW, Activity.LOST, Activity.CALLING)
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Vitals:
    """What the panel shows of a mission at one moment.

    Attributes:
        done_s, duration_s: of MISSION. history: coverage in equal slices of MISSION so far, None where none was there.
        activities: what each agent does, by uid. seen, present: targets now. coverage: mean so far.
        losses, calls, helpers: target losses so far; calls that are out now, and agents on their way.
        faults: so far. realtime_factor: mission seconds a second. left_s: wall time to the end of MISSION, if known.
        late_s: how late the last tick began.
    """

    title: str
    phase: Phase
    done_s: float
    duration_s: float
    activities: Sequence[Activity]
    seen: int
    present: int
    coverage: float | None
    history: Sequence[float | None]
    losses: int
    calls: int
    helpers: int
    faults: int
    realtime_factor: float | None
    left_s: float | None
    late_s: float


def panel_of(vitals: Vitals) -> RenderableType:
    """The vitals as a panel."""
    table = Table.grid(padding=(0, 2))
    table.add_column(style="dim")
    table.add_column()
    table.add_row(vitals.phase.value, _progress(vitals))
    table.add_row("coverage", _coverage(vitals))
    table.add_row("agents", _agents(vitals))
    table.add_row("targets", _targets(vitals))
    table.add_row("speed", _speed(vitals))
    return Panel(table, title=Text(vitals.title, "bold"), title_align="left", border_style="dim", width=_WIDTH)


def line_of(vitals: Vitals) -> str:
    """The vitals on one line, for logs."""
    counts = ", ".join(f"{count} {activity.value}" for activity, count in _counted(vitals.activities))
    where = f"{_clock(vitals.done_s)} of {_clock(vitals.duration_s)}, " if vitals.phase is Phase.MISSION else ""
    seen = f"{vitals.seen} of {vitals.present} targets seen, " if vitals.phase is Phase.MISSION else ""
    mean = "" if vitals.coverage is None else f"coverage {vitals.coverage:.1%}, {vitals.losses} losses, "
    return f"{vitals.phase.value}: {where}{seen}{mean}{counts}"


def _progress(vitals: Vitals) -> RenderableType:
    bar = ProgressBar(
        total=vitals.duration_s,
        completed=vitals.done_s,
        width=_BAR_COLUMNS,
        complete_style=_GOOD,
        finished_style=_GOOD,
    )
    left = "" if vitals.left_s is None else f"   {_clock(vitals.left_s)} left"
    words = Text(f"{_clock(vitals.done_s)} of {_clock(vitals.duration_s)}{left}")
    row = Table.grid(padding=(0, 2))
    row.add_row(bar, words)
    return row


def _coverage(vitals: Vitals) -> Text:
    text = Text()
    for share in vitals.history:
        block = " " if share is None else _BLOCKS[round(share * (len(_BLOCKS) - 1))]
        text.append(block, _GOOD)
    text.append(" " * (_BAR_COLUMNS - len(vitals.history)))
    text.append("  –" if vitals.coverage is None else f"  {vitals.coverage:.1%} so far")
    return text


def _agents(vitals: Vitals) -> Group:
    """A block for each agent (or for several, where they are many), sorted by what they do; and how many do it."""
    lane, words = Text(), Text()
    share = max(1, -(-len(vitals.activities) // _BAR_COLUMNS))
    width = max(1, min(4, _BAR_COLUMNS // max(1, len(vitals.activities))))
    for activity, count in _counted(vitals.activities):
        lane.append("█" * max(1, round(count / share)) * width, hex_color(ACTIVITY_COLORS[activity]))
        words.append(f"{count} {activity.value}   ", hex_color(ACTIVITY_INKS[activity]))
    return Group(lane, words)


def _targets(vitals: Vitals) -> Text:
    lost = Text(f"{vitals.losses} lost so far", _BAD if vitals.losses else "dim")
    if vitals.phase is not Phase.MISSION:
        return lost
    return Text.assemble(
        (f"{vitals.seen} of {vitals.present} seen", _GOOD if vitals.seen == vitals.present else ""),
        "   ",
        lost,
        "   ",
        (f"{vitals.calls} called for", _WARN if vitals.calls else "dim"),
        "   ",
        (f"{vitals.helpers} helping", hex_color(ACTIVITY_INKS[Activity.HELPING]) if vitals.helpers else "dim"),
    )


def _speed(vitals: Vitals) -> Text:
    factor = "–" if vitals.realtime_factor is None else f"{vitals.realtime_factor:.1f} × real time"
    late = f"   a tick {1000 * vitals.late_s:.0f} ms late" if vitals.late_s >= 0.001 else ""
    faults = f"   {vitals.faults} faults" if vitals.faults else ""
    return Text.assemble(factor, (late, _WARN), (faults, _BAD))


def _counted(activities: Sequence[Activity]) -> Iterator[tuple[Activity, int]]:
    counts = Counter(activities)
    return ((activity, counts[activity]) for activity in Activity if counts[activity])


def _clock(time_s: float) -> str:
    return f"{round(time_s) // 60}:{round(time_s) % 60:02d}"
