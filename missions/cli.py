"""The command line: `swarm VERB ...`. What each verb is lies in `missions.commands`.

Exit codes: 0 done, 1 the mission failed, 2 bad input, 130 stopped by Ctrl-C, 141 nobody reads what it prints (a flight
goes on). Mistakes in a mission go to standard error, one line each.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Sequence

from missions.commands import COMMANDS
from missions.commands.command import Command
from missions.exit_codes import BAD_INPUT, STOPPED, UNREAD
from missions.problems import InputError

_TOP = """examples:
  swarm launch quickstart              fly ten agents over ten targets
  swarm launch quickstart --set agents.count=5 --report -
  swarm check my.yaml                  every mistake, with line, key and what is allowed
  swarm plan wildlife                  what would run, as tables
  swarm review out/q.rrd               what happened in a recorded mission, and why
  swarm sim --port 5760                one vehicle for QGroundControl, MAVProxy or MAVSDK
  swarm study figure-16 --runs 20      many missions, compared

`swarm VERB --help` tells more. Exit codes: 0 done, 1 the mission failed, 2 bad input, 130 stopped by Ctrl-C."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command line (without the program's name; default: the process's own) and return its exit code."""
    try:
        options = _parser().parse_args(_joined(sys.argv[1:] if arguments is None else arguments))
    except SystemExit as stop:  # argparse has printed help or what is wrong
        return stop.code if isinstance(stop.code, int) else BAD_INPUT
    command: Command = options.command
    try:
        code = command.run(options)
        sys.stdout.flush()
        return code
    except InputError as error:
        sys.stderr.write(f"{error}\n")
        return BAD_INPUT
    except KeyboardInterrupt:
        return STOPPED
    except (BrokenPipeError, SystemExit):  # rich makes the one of the other
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # or Python complains when it exits
        return UNREAD


def _joined(arguments: Sequence[str]) -> list[str]:
    """`--home -35.4,149.2,584,0` as `--home=-35.4,...`: argparse takes what begins with a minus for another option."""
    joined: list[str] = []
    for word in arguments:
        if re.match(r"-[\d.]", word) and joined and re.fullmatch(r"--[a-z-]+", joined[-1]):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="swarm",
        description="Fly a swarm of MAVLink drones that keeps moving targets in sight.",
        epilog=_TOP,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"%(prog)s {_version()}")
    verbs = parser.add_subparsers(title="verbs", metavar="VERB", required=True)
    for command in COMMANDS:
        about = f"{command.summary[0].upper()}{command.summary[1:]}."
        own = verbs.add_parser(
            command.name,
            help=command.summary,
            usage=command.usage,
            description=about,
            epilog=command.examples,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        own.set_defaults(command=command)
        command.add_options(own)
    return parser


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("swarm-mission-stack")
    except PackageNotFoundError:
        return "(not installed)"


if __name__ == "__main__":
    sys.exit(main())
