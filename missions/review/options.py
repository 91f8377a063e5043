"""What `swarm review` understands."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from missions.problems import InputError
from missions.review.words import clock_s

_MOST = 2
EXAMPLES = """examples:
  swarm review out/quickstart.rrd                          what happened, on one page
  swarm review out/quickstart.rrd --events                 when, who, what and why
  swarm review out/quickstart.rrd --at 2:31 --agent 4      what it knew, wanted and did
  swarm review out/quickstart.rrd --report out/flight.html  one page with pictures, for a colleague
  swarm review out/quickstart.rrd --plot out/flight.png
  swarm review out/quickstart.rrd --view                   look at it; --web: in a browser
  swarm review out/first.rrd out/second.rrd                what differs between two missions
  swarm review out/quickstart.rrd --check 'coverage > .9 and events.target_loss < 20'
  swarm review out/quickstart.rrd --json | jq .coverage

All of it comes from the recording alone, of a long mission from F.0002.rrd and so on, too. One whose recorder was
killed (F.rrd.part) is repaired to be read.
Exit codes: 0 done, 1 a check fails, 2 bad input."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReviewOptions:
    """Options of `swarm review`. Without any it prints the summary.

    Attributes:
        recordings: one, or two to compare.
        json: print the report. events: print the timeline: None, "main" or "all".
        at_s, agent: print what that agent was at at that time (mission clock); both or neither.
        plot, page: the picture and the HTML page to write. checks: conditions that must hold.
        view, web: show the recordings in the viewer's window, or serve its page until Ctrl-C.
    """

    recordings: Sequence[Path]
    json: bool = False
    events: str | None = None
    at_s: float | None = None
    agent: int | None = None
    plot: Path | None = None
    page: Path | None = None
    checks: Sequence[str] = ()
    view: bool = False
    web: bool = False


def add_options(parser: argparse.ArgumentParser) -> None:
    """The options of the verb."""
    parser.add_argument("recordings", nargs="+", type=Path, metavar="F.rrd", help="a recording")
    parser.add_argument("--json", action="store_true", help="the report, counted from the recording, as JSON")
    parser.add_argument(
        "--events",
        nargs="?",
        const="main",
        choices=("main", "all"),
        help="the timeline; all: with every word of the autopilots",
    )
    parser.add_argument("--at", type=_clock, metavar="M:SS", help="a moment of the mission clock; needs --agent")
    parser.add_argument("--agent", type=int, metavar="N", help="the agent whose moment it is: 4 is A4; needs --at")
    parser.add_argument(
        "--plot", type=Path, metavar="F.png", help="coverage, activities and distances over time, as .png or .svg"
    )
    parser.add_argument("--report", type=Path, metavar="F.html", help="one page with all of it and its pictures")
    parser.add_argument("--view", action="store_true", help="open it in the viewer's window")
    parser.add_argument("--web", action="store_true", help="serve it to browsers on this computer, until Ctrl-C")
    parser.add_argument(
        "--check",
        action="append",
        default=[],
        metavar="CONDITION",
        help="exit code 1 unless it holds, such as 'coverage > .9'; may be repeated",
    )


def review_options(options: argparse.Namespace) -> ReviewOptions:
    """The options as a value.

    Raises:
        InputError: they do not go together.
    """
    if (options.at is None) != (options.agent is None):
        given, missing = ("--at", "--agent") if options.agent is None else ("--agent", "--at")
        raise InputError(f"{given}: got no {missing}; allowed: both, such as --at 2:31 --agent 4")
    count = len(options.recordings)
    if count > _MOST:
        raise InputError(f"F.rrd: got {count} recordings; allowed: one, or two to compare")
    if options.view and options.web:
        raise InputError("--view: got --web too; allowed: one of them")
    one_only = {"--events": options.events, "--at": options.at, "--report": options.report, "--json": options.json}
    for name, value in one_only.items():
        if count == _MOST and value:
            raise InputError(f"{name}: got {count} recordings; allowed: one")
    return ReviewOptions(
        recordings=tuple(options.recordings),
        json=options.json,
        events=options.events,
        at_s=options.at,
        agent=options.agent,
        plot=options.plot,
        page=options.report,
        checks=tuple(options.check),
        view=options.view,
        web=options.web,
    )


def _clock(text: str) -> float:
    try:
        return clock_s(text)
    except InputError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
