"""A review as one page of HTML with its pictures inside: to be sent to a colleague, read without network."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from importlib.resources import files
from string import Template

from missions.colors import ACTIVITY_COLORS, LEVEL_INKS, hex_color
from missions.review.calls import Fate
from missions.review.figures.from_above import from_above
from missions.review.figures.output import part_of_page
from missions.review.figures.over_time import over_time
from missions.review.highlights import highlights, told
from missions.review.losses import Loss, longest
from missions.review.reading import Review
from missions.review.summary import injected_rows
from missions.review.timeline import Line, call_words, found_words, loss_words
from missions.review.words import agent, clock, percent

_ABOUT_TIME = "Over time: faults on purpose, coverage, what each agent does, and how far targets are from agents"
_ABOUT_PATHS = "From above: the paths of agents and targets, and where targets were lost"
# Losses that are shown at once; the others are one click away.
_SHOWN_LOSSES = 12
_LOSS_HEAD = ("time", "who", "what", "in the end")


def page_of(review: Review) -> str:
    """The page."""
    report = review.report
    title = f"{report['mission']}, seed {report['seed']}"
    template = Template((files("missions.review") / "page.html").read_text(encoding="utf-8"))
    worst = longest(review.losses, _SHOWN_LOSSES)
    others = [loss for loss in review.losses if loss not in worst]
    return template.substitute(
        title=escape(title),
        subtitle=escape(
            f"{report['agents']} agents over {report['targets']} targets, {report['policy']}, "
            f"{clock(report['duration_s'])} of mission, {'complete' if review.complete else 'not complete'}"
        ),
        notes="".join(f'<p class="note">{escape(note)}</p>' for note in review.notes),
        tiles="".join(map(_tile, _tiles(review))),
        highlights="".join(map(_highlight, map(told, highlights(review))))
        or "<li>Nothing: no target was lost for long.",
        over_time=part_of_page(over_time(review, titled=False), about=_ABOUT_TIME),
        from_above=part_of_page(from_above(review), about=_ABOUT_PATHS),
        losses=_table(_LOSS_HEAD, map(_loss_row, worst)),
        shorter_losses=_details(f"{len(others)} shorter losses", _table(_LOSS_HEAD, map(_loss_row, others)))
        if others
        else "",
        calls=_details(
            f"{len(review.calls)} help calls, and their fate",
            _table(
                ("began", "caller", "how it went"),
                ((clock(call.began_s), agent(call.caller), call_words(call)) for call in review.calls),
            ),
        ),
        faults=_table(
            ("time", "who", "what"),
            (
                (clock(fault["time_s"]), "mission" if fault["agent"] is None else agent(fault["agent"]), fault["what"])
                for fault in report["faults"]
            ),
        ),
        injected=_table(("at", "what", "noticed", "seen before", "during", "after"), injected_rows(review)),
        timeline="".join(_line(line) for line in review.lines if not line.routine),
        mission=escape(review.playback.mission_yaml),
        versions=escape(", ".join(f"{name} {version}" for name, version in report["versions"].items())),
        recording=escape(review.playback.path.name),
    )


def _highlight(row: tuple[str, str]) -> str:
    when, what = map(escape, row)
    return f"<li><b>{when}</b>{what}" if when else f"<li>{what}"


def _details(summary: str, inside: str) -> str:
    return f"<details><summary>{escape(summary)}</summary>{inside}</details>"


def _tiles(review: Review) -> Sequence[tuple[str, str, str]]:
    """(label, number, what to hold it against) of what one wants to know first."""
    report = review.report
    events, helped, radio, mavlink = (report[key] for key in ("events", "help", "radio", "mavlink"))
    utilization = report["utilization"]
    handed_over = sum(call.fate is Fate.HANDED_OVER for call in review.calls)
    reached = radio["delivered"] + radio["out_of_range"] + radio["lost"]
    return (
        ("coverage", percent(report["coverage"]), f"standing still at random: {percent(report['coverage_floor'])}"),
        ("last quarter", percent(report["coverage_late"]), "coverage"),
        ("utilization", "–" if utilization is None else f"{utilization:.2f}", "targets seen per agent"),
        ("losses", str(events["target_loss"]), f"{events['target_discovery']} discovered"),
        ("help calls", str(helped["calls"]), f"{handed_over} handed over to helpers"),
        (
            "radio",
            percent(radio["delivered"] / reached if reached else None),
            f"of frames reached a mate, {radio['lost']} lost",
        ),
        (
            "MAVLink",
            str(sum(end[what] for end in (mavlink, mavlink["vehicles"]) for what in ("bad", "dropped"))),
            f"bad or dropped of {mavlink['received'] + mavlink['vehicles']['received']}",
        ),
        ("faults", str(len(report["faults"])), "what should not have happened"),
    )


def _tile(tile: tuple[str, str, str]) -> str:
    label, number, against = map(escape, tile)
    return f'<div class="tile"><span>{label}</span><strong>{number}</strong><small>{against}</small></div>'


def _loss_row(loss: Loss) -> tuple[str, str, str, str]:
    return clock(loss.time_s), agent(loss.owners[0]), loss_words(loss), found_words(loss)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    body = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
    if not body:
        return '<p class="none">None.</p>'
    names = "".join(f'<th scope="col">{escape(name)}' for name in head)
    return f'<div class="wide"><table><thead><tr>{names}</thead><tbody>{body}</tbody></table></div>'


def _line(line: Line) -> str:
    color = LEVEL_INKS[line.level]
    doing = "" if line.activity is None else line.activity.value
    dot = hex_color(color if line.activity is None else ACTIVITY_COLORS[line.activity])
    who = "mission" if line.who is None else agent(line.who)
    cells = (clock(line.time_s), who, doing, line.text)
    first, second, third, fourth = map(escape, cells)
    return (
        f'<tr class="{line.level.value}"><td>{first}</td><td>{second}</td>'
        f'<td><i style="background:{dot}"></i>{third}</td><td>{fourth}</td></tr>'
    )
