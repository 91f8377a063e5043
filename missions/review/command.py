"""`swarm review`: the shell around a review. Files and terminal are here."""

from __future__ import annotations

import sys
from pathlib import Path

from rich.console import Console

from missions.exit_codes import DONE, FAILED
from missions.problems import InputError
from missions.report import as_json
from missions.review.checks import countable, judge
from missions.review.comparison import print_comparison
from missions.review.figures.output import write_picture
from missions.review.figures.over_time import over_time
from missions.review.figures.side_by_side import side_by_side
from missions.review.lines import print_line
from missions.review.moment import print_moment
from missions.review.options import ReviewOptions
from missions.review.page import page_of
from missions.review.reading import Review, When, read
from missions.review.showing import show
from missions.review.summary import print_summary

_WIDE = 160
_PAGES = (".html", ".htm")


def review(options: ReviewOptions) -> int:
    """Read recordings, and print and write what was asked for; a summary if nothing was. Returns the exit code.

    Raises:
        InputError: a recording cannot be read, a question makes no sense, or a file cannot be written.
    """
    # Where nobody looks lines are not folded: they are for other programs. Beside JSON for one, words go to people.
    looked_at = sys.stderr if options.json else sys.stdout
    width = None if looked_at.isatty() else _WIDE
    console = Console(highlight=False, emoji=False, markup=False, width=width, stderr=options.json)
    moment = None if options.at_s is None or options.agent is None else When(options.at_s, options.agent)
    reviews = [read(path, moment=moment) for path in options.recordings]
    verdicts = [(one, judge(text, countable(one.report))) for one in reviews for text in options.checks]
    if len(reviews) > 1:
        _compare(reviews[0], reviews[1], options, console)
    else:
        _tell(reviews[0], options, console)
    if options.view or options.web:
        show(options.recordings, console, window=options.view)
    for one, verdict in verdicts:
        whose = f"{one.playback.path.name}: " if len(reviews) > 1 else ""
        console.print(f"{whose}{verdict}", style="" if verdict.holds else "bold red", markup=False)
    return DONE if all(verdict.holds for _, verdict in verdicts) else FAILED


def _compare(first: Review, second: Review, options: ReviewOptions, console: Console) -> None:
    if options.plot is not None:
        write_picture(side_by_side(first, second), options.plot)
        _written(options.plot, console)
    elif not options.checks:
        print_comparison(first, second, console)


def _tell(one: Review, options: ReviewOptions, console: Console) -> None:
    if options.json:
        sys.stdout.write(as_json(one.report))
    if options.events:
        _print_events(one, console, everything=options.events == "all")
    if one.moment is not None:
        print_moment(one, one.moment, console)
    if options.plot is not None:
        write_picture(over_time(one), options.plot)
        _written(options.plot, console)
    if options.page is not None:
        _write(options.page, page_of(one))
        _written(options.page, console)
    asked = (options.json, options.events, options.at_s is not None, options.plot, options.page, options.checks)
    if not any(asked):
        print_summary(one, console)


def _write(path: Path, text: str) -> None:
    if path.suffix.lower() not in _PAGES:
        raise InputError(f"--report: got {path}; allowed: a file that ends with {' or '.join(_PAGES)}")
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise InputError(f"--report: got {path}; allowed: a file that can be written ({error.strerror})") from error


def _written(path: Path, console: Console) -> None:
    console.print(str(path), markup=False, soft_wrap=True)


def _print_events(one: Review, console: Console, *, everything: bool) -> None:
    for line in one.lines:
        if everything or not line.routine:
            print_line(line, console)
