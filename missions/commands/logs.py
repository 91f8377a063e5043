"""`swarm review` and `swarm import`: what is left of a mission when it is over."""

from __future__ import annotations

import argparse
from pathlib import Path

from missions.arguments import new_file
from missions.commands.command import Command, need_extra
from missions.exit_codes import DONE
from missions.review.options import EXAMPLES, add_options, review_options

_PACKAGES = ("numpy", "rerun", "matplotlib")

_IMPORT = """examples:
  swarm import flight.tlog --to out/flight.rrd         a log of MAVProxy or QGroundControl
  swarm import out/logs/*.tlog --to out/swarm.rrd      what swarm launch --tlog out/logs kept, all vehicles in one

Look at it with rerun. A run of a study needs no import: swarm launch MISSION --set vehicle.kind=ideal --seed N
--record F.rrd flies and records the very same."""


def _review(options: argparse.Namespace) -> int:
    need_extra("review", "ground", _PACKAGES)
    from missions.review.command import review

    return review(review_options(options))


def _add_import(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("logs", nargs="+", type=Path, metavar="F.tlog", help="a telemetry log")
    parser.add_argument("--to", type=new_file, required=True, metavar="F.rrd", help="the recording to write")


def _import(options: argparse.Namespace) -> int:
    need_extra("import", "ground", _PACKAGES)
    from missions.conversion import import_logs

    import_logs(options.logs, options.to)
    return DONE


REVIEW = Command(
    name="review",
    summary="tell what happened, from a recording",
    examples=EXAMPLES,
    add_options=add_options,
    run=_review,
)
IMPORT = Command(
    name="import",
    summary="make a recording of flight logs",
    examples=_IMPORT,
    add_options=_add_import,
    run=_import,
)
