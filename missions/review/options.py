"""What `swarm review` understands."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

EXAMPLES = """examples:
  swarm review out/quickstart.rrd                          what happened, on one page
  swarm review out/quickstart.rrd --events                 when, who, what and why
  swarm review out/quickstart.rrd --at 2:31 --agent 4      what it saw, wanted and did
  swarm review out/quickstart.rrd --check 'coverage > .9 and events.target_loss < 20'
  swarm review out/quickstart.rrd --json

A recording whose recorder was killed (F.rrd.part) is repaired to be read. Exit codes: 0 done, 1 a check fails,
2 bad input."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReviewOptions:
    """Options of `swarm review`. Without any it prints the summary.

    Attributes:
        recordings: one, or two to compare. events: None, "main" or "all".
        checks: conditions that must hold.
    """

    recordings: Sequence[Path]
    json: bool = False
    events: str | None = None
    checks: Sequence[str] = ()


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
    parser.add_argument(
        "--check",
        action="append",
        default=[],
        metavar="CONDITION",
        help="exit code 1 unless it holds, such as 'coverage > .9'; may be repeated",
    )


def review_options(options: argparse.Namespace) -> ReviewOptions:
    """The options as a value."""
    return ReviewOptions(
        recordings=tuple(options.recordings),
        json=options.json,
        events=options.events,
        checks=tuple(options.check),
    )
