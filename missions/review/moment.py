"""One agent at one moment: where it was, what it followed and wanted, what it knew, and what it said about then."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, degrees, hypot

from rich.console import Console, Group, RenderableType
from rich.markdown import Markdown
from rich.table import Table
from rich.text import Text

from comms.status import OFF_DUTY, Activity
from missions.colors import ACTIVITY_INKS, hex_color
from missions.observation import Observation
from missions.problems import InputError
from missions.review.lines import print_line
from missions.review.reading import Moment, Review
from missions.review.words import agent, agents, clock, target

# Lines so much earlier and later are shown.
_ABOUT_S, _NOW_S = 10.0, 0.5


def print_moment(review: Review, moment: Moment, console: Console) -> None:
    """Print the moment.

    Raises:
        InputError: there is no such agent, or the recording does not reach so far.
    """
    (time_s, uid), seen, _ = moment
    first, last = review.series.time_s[0], review.ended_s
    if not 0 <= uid < review.playback.facts.agents:
        raise InputError(f"--agent: got {uid}; allowed: 0 to {review.playback.facts.agents - 1}")
    if not first <= time_s <= last + 1.0:
        raise InputError(f"--at: got {clock(time_s)}; allowed: {clock(first)} to {clock(last)}")
    console.print(Group(_title(seen, uid), Text(), _facts(review, seen, uid), *_page(review, moment)))
    nearby = [line for line in review.lines if line.who == uid and abs(line.time_s - seen.time_s) <= _ABOUT_S]
    if nearby:
        console.print(Text("\nWhat happened about then", "bold"))
    for line in nearby:
        now = abs(line.time_s - seen.time_s) < _NOW_S
        print_line(line, console, style="bold" if now else "dim" if line.time_s > seen.time_s else "default")


def _title(seen: Observation, uid: int) -> Text:
    activity = seen.statuses[uid].activity
    color = hex_color(ACTIVITY_INKS[activity])
    return Text.assemble((f"{agent(uid)} at {clock(seen.time_s)}: ", "bold"), (activity.value, f"bold {color}"))


def _facts(review: Review, seen: Observation, uid: int) -> Table:
    status, truth = seen.statuses[uid], seen.truths[uid]
    on_duty = status.activity not in OFF_DUTY
    table = Table.grid(padding=(0, 2))
    table.add_column(style="dim")
    table.add_column()
    east, north, up = truth.position_m
    speed_m_s = hypot(*truth.velocity_m_s[:2])
    course_deg = degrees(atan2(truth.velocity_m_s[0], truth.velocity_m_s[1])) % 360
    flying = f"{speed_m_s:.1f} m/s towards {course_deg:03.0f}°" if speed_m_s > 0.05 else "standing still"
    battery = "" if status.battery is None else f", battery {100 * status.battery:.0f} %"
    table.add_row("where", f"{east:.1f} m east, {north:.1f} m north, {up:.1f} m up, {flying}")
    table.add_row("autopilot", f"{status.flight_mode or 'silent'}{battery}")
    table.add_row("follows", ", ".join(_away(seen, uid, number) for number in status.tags) or "nobody")
    in_sight = [
        number
        for number, other in enumerate(seen.targets)
        if other.present and number not in status.tags and _distance_m(seen, uid, number) <= review.sensing_range_m
    ]
    if in_sight and on_duty:
        table.add_row("also in range", ", ".join(_away(seen, uid, number) for number in in_sight))
    for call in status.calls:
        what = f"help for {target(call.target)}, to be lost in {call.loss_in_s:.1f} s when it began"
        table.add_row("calls", what if call.urgent else f"offers {target(call.target)}")
    if status.helping is not None:
        callers = [s.uid for s in seen.statuses if any(call.target == status.helping for call in s.calls)]
        table.add_row(
            "helps with", f"{_away(seen, uid, status.helping)}" + (f", called by {agents(callers)}" if callers else "")
        )
    mates = [a if b == uid else b for a, b in seen.links if uid in (a, b)]
    if on_duty:
        table.add_row("in touch with", agents(mates) or "nobody")
    return table


def _distance_m(seen: Observation, uid: int, number: int) -> float:
    x, y, _ = seen.truths[uid].position_m
    return hypot(seen.targets[number].x_m - x, seen.targets[number].y_m - y)


def _away(seen: Observation, uid: int, number: int) -> str:
    return f"{target(number)} ({_distance_m(seen, uid, number):.1f} m away)"


def _page(review: Review, moment: Moment) -> Iterator[RenderableType]:
    """What it told of its mind last, if it told anything."""
    if moment.page is not None:
        tick, text = moment.page
        told = clock(tick * review.playback.facts.tick_s)
        lost = moment.seen.statuses[moment.when.agent].activity is Activity.LOST
        yield Text(f"\n{'What it last knew' if lost else 'What it knew'} and wanted, told at {told}", "bold")
        yield from _told(text.partition("\n")[2])  # its title says what ours says


def _told(page: str) -> Iterator[RenderableType]:
    """Markdown, with its table closer together: nine columns in eighty."""
    for part in page.strip().split("\n\n"):
        rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in part.splitlines() if row[:1] == "|"]
        if not rows:
            yield Markdown(part)
            continue
        table = Table(*rows[0], box=None, pad_edge=False, header_style="dim")
        for row in rows[2:]:  # the second row is a line
            table.add_row(*row)
        yield Group(Text(), table, Text())
