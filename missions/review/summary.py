"""A review on one page of a terminal: outcome, what stands out, coverage over time, losses, calls, radio, faults."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from math import inf

from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from comms.status import Activity, Level
from missions.colors import ACTIVITY_COLORS, ACTIVITY_INKS, LEVEL_INKS, hex_color
from missions.review.calls import Fate
from missions.review.highlights import LONG_S, Highlight, highlights, told
from missions.review.losses import longest
from missions.review.reading import Review
from missions.review.series import Bucket
from missions.review.timeline import found_words, loss_words
from missions.review.words import agent, clock, percent

_BLOCKS = " ▁▂▃▄▅▆▇█"
_COLUMNS = 60
_FATES = {
    Fate.HANDED_OVER: "handed over",
    Fate.TAKEN: "taken by passers-by",
    Fate.KEPT: "kept",
    Fate.LOST: "lost",
    Fate.OPEN: "out until the end",
}
_SHOWN_LOSSES, _SHOWN_FAULTS = 12, 12
_GOOD, _BAD, _DIM = hex_color(ACTIVITY_INKS[Activity.FOLLOW]), hex_color(ACTIVITY_INKS[Activity.LOST]), "dim"
_WARN = hex_color(LEVEL_INKS[Level.WARNING])


def print_summary(review: Review, console: Console) -> None:
    """Print the page."""
    console.print(Group(*_parts(review)))


def _parts(review: Review) -> Iterable[RenderableType]:
    yield _title(review)
    yield from (Text(note, _WARN) for note in review.notes)
    yield Text()
    if found := highlights(review):
        yield _highlights(found)
        yield Text()
    yield _facts(review)
    if review.losses:
        yield Text()
        yield _losses(review)
    if review.report["injected"]:
        yield Text()
        yield _injected(review)
    if review.report["faults"]:
        yield Text()
        yield _faults(review)


def _title(review: Review) -> Text:
    report = review.report
    outcome = ("complete", _GOOD) if review.complete else ("not complete", _BAD)
    return Text.assemble(
        (f"{report['mission']}", "bold"),
        f", seed {report['seed']}: {report['agents']} agents over {report['targets']} targets, {report['policy']}, "
        f"{clock(report['duration_s'])} of mission, ",
        outcome,
    )


def _facts(review: Review) -> Table:
    report = review.report
    events, radio, mavlink = report["events"], report["radio"], report["mavlink"]
    table = Table.grid(padding=(0, 2))
    table.add_column(style=_DIM)
    table.add_column()
    table.add_row(
        "coverage",
        Text.assemble(
            (percent(report["coverage"]), "bold"),
            f"   last quarter {percent(report['coverage_late'])}   floor {percent(report['coverage_floor'])}",
        ),
    )
    slices = review.series.buckets(_COLUMNS)
    if slices:
        table.add_row("over time", _spark(slices))
        table.add_row("doing", _lane(slices))
    utilization = report["utilization"]
    table.add_row("utilization", "–" if utilization is None else f"{utilization:.2f} targets seen per agent")
    table.add_row(
        "targets",
        f"{events['target_discovery']} discovered, {events['target_loss']} lost, "
        f"{events['tag_switch']} passed from one to another",
    )
    table.add_row("help", _help_words(review))
    reached = radio["delivered"] + radio["out_of_range"] + radio["lost"]
    share = percent(radio["delivered"] / reached if reached else None)
    table.add_row(
        "radio",
        f"{radio['sent']} frames, {radio['bytes'] / 1e6:.1f} MB; {share} reached a mate, {radio['out_of_range']} "
        f"were out of range, {radio['lost']} lost",
    )
    vehicles = mavlink["vehicles"]
    table.add_row(
        "MAVLink",
        f"{mavlink['sent']} sent, {mavlink['received']} received; "
        f"{mavlink['bad'] + vehicles['bad']} bad, {mavlink['dropped'] + vehicles['dropped']} dropped",
    )
    late_s = report["timing"]["tick_late_s_max"]
    table.add_row("lateness", f"{1000 * late_s:.0f} ms at worst" if late_s else "none (lockstep)")
    return table


def _spark(slices: Sequence[Bucket]) -> Text:
    """Coverage over the mission as a row of blocks."""
    spark = Text()
    for bucket in slices:
        share = bucket.coverage
        level = 0 if share is None else max(1, round(share * (len(_BLOCKS) - 1)))
        spark.append(_BLOCKS[level], _GOOD if share is not None and share >= 0.9 else "")
    return spark


def _lane(slices: Sequence[Bucket]) -> Text:
    """What most agents did over the mission, as a row of colors, and what they stand for."""
    lane, shares = Text(), Counter[Activity]()
    for bucket in slices:
        shares += bucket.activities
        activity = bucket.activities.most_common(1)[0][0]
        lane.append("█", hex_color(ACTIVITY_COLORS[activity]))
    whole = shares.total()
    lane.append("\n")
    for activity, count in shares.most_common():
        lane.append(f"{activity.value} {100 * count / whole:.0f} %  ", hex_color(ACTIVITY_INKS[activity]))
    return lane


def _help_words(review: Review) -> str:
    report = review.report["help"]
    fates = Counter(call.fate for call in review.calls)
    ends = ", ".join(f"{fates[fate]} {words}" for fate, words in _FATES.items() if fates[fate])
    helped = f"{report['answered']} set out to help"
    if report["pursued"]:
        helped += f", {report['pursued']} after what they had lost themselves"
    return f"{report['calls']} calls" + (f": {ends}" if ends else "") + f"; {helped}"


def _highlights(found: Iterable[Highlight]) -> Table:
    table = Table(title="What stands out", title_justify="left", title_style="bold", box=None, pad_edge=False)
    table.show_header = False
    for row in map(told, found):
        table.add_row(*row)
    return table


def _losses(review: Review) -> Table:
    table = Table(title="Losses", title_justify="left", title_style="bold", box=None, pad_edge=False, show_header=False)
    for loss in longest(review.losses, _SHOWN_LOSSES):
        color = _BAD if not loss.left and (loss.found_after_s or inf) > LONG_S else ""
        table.add_row(clock(loss.time_s), agent(loss.owners[0]), loss_words(loss), Text(found_words(loss), color))
    if len(review.losses) > _SHOWN_LOSSES:
        table.add_row("", "", Text(f"and {len(review.losses) - _SHOWN_LOSSES} shorter ones: --events", _DIM), "")
    return table


def _injected(review: Review) -> Table:
    """The mission's own faults: what was seen before, meanwhile and afterwards."""
    table = Table(title="Faults on purpose", title_justify="left", title_style="bold", box=None, pad_edge=False)
    for name in ("at", "what", "noticed", "seen before", "during", "after"):
        table.add_column(name, justify="left" if name in ("at", "what", "noticed") else "right")
    for row in injected_rows(review):
        table.add_row(*row)
    return table


def injected_rows(review: Review) -> Iterable[tuple[str, ...]]:
    """Of each fault on purpose: at, what, noticed; and what was seen before, during, and after."""
    for fault in review.report["injected"]:
        after_s = fault["noticed_after_s"]
        by = "the mission" if fault["noticed_by"] is None else agent(fault["noticed_by"])
        noticed = "never" if after_s is None else f"after {after_s:.1f} s by {by}"
        shares = [percent(fault["coverage"][when]) for when in ("before", "during", "after")]
        yield clock(fault["at_s"] + (review.began_s or 0.0)), f"{fault['what']}, {fault['whom']}", noticed, *shares


def _faults(review: Review) -> Table:
    faults = review.report["faults"]
    table = Table(title="Faults", title_justify="left", title_style=f"bold {_BAD}", box=None, pad_edge=False)
    table.show_header = False
    for fault in faults[:_SHOWN_FAULTS]:
        who = "mission" if fault["agent"] is None else agent(fault["agent"])
        table.add_row(clock(fault["time_s"]), who, fault["what"])
    if len(faults) > _SHOWN_FAULTS:
        table.add_row("", "", Text(f"and {len(faults) - _SHOWN_FAULTS} more: --json", _DIM))
    return table
