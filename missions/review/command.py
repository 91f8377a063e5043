"""`swarm review`: the shell around a review. Files and terminal are here."""

from __future__ import annotations

import sys

from rich.console import Console
from rich.text import Text

from comms.status import Level
from missions.colors import ACTIVITY_COLORS, LEVEL_COLORS, hex_color
from missions.problems import InputError
from missions.report import as_json
from missions.review.checks import judge, numbers_of
from missions.review.options import ReviewOptions
from missions.review.reading import Review, read
from missions.review.summary import print_summary
from missions.review.timeline import Line

DONE, FAILED = 0, 1


def review(options: ReviewOptions) -> int:
    """Read recordings and print or write what was asked for. Returns the exit code.

    Raises:
        InputError: a recording cannot be read, or a question makes no sense.
    """
    console = Console(highlight=False, emoji=False, soft_wrap=not sys.stdout.isatty())
    if len(options.recordings) != 1:
        raise InputError(f"F.rrd: got {len(options.recordings)} recordings; allowed: 1")
    reviewed = read(options.recordings[0])
    verdicts = [judge(condition, numbers_of(reviewed.report)) for condition in options.checks]
    if options.json:
        sys.stdout.write(as_json(reviewed.report))
    if options.events:
        _print_events(reviewed, console, everything=options.events == "all")
    if not (options.json or options.events or options.checks):
        print_summary(reviewed, console)
    for verdict in verdicts:
        console.print(str(verdict), style="" if verdict.holds else "bold red", markup=False)
    return DONE if all(verdict.holds for verdict in verdicts) else FAILED


def _print_events(reviewed: Review, console: Console, *, everything: bool) -> None:
    for line in reviewed.lines:
        if everything or not line.routine:
            console.print(_colored(line))


def _colored(line: Line) -> Text:
    color = LEVEL_COLORS[line.level]
    if line.level is Level.INFO and line.activity is not None:
        color = ACTIVITY_COLORS[line.activity]
    return Text(str(line), hex_color(color))
