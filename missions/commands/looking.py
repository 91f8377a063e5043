"""`swarm check`, `swarm plan`, `swarm schema`: a mission before it flies."""

from __future__ import annotations

import argparse
import json
import sys

from missions.commands.command import Command
from missions.commands.which import add_mission, add_set, changes, mission_help, mission_of
from missions.daemons.arguments import add_processes
from missions.exit_codes import BAD_INPUT, DONE
from missions.load import load_mission
from missions.problems import InputError

_NEVER_WRAP = 1000

_CHECK = """examples:
  swarm check my.yaml other.yaml
  swarm check baboons --set targets.file=baboons.csv.gz

A mistake reads  FILE:LINE: KEY: got VALUE; allowed: VALUES  and all of them are printed at once, to standard error.
Every key, its meaning and default: `swarm plan reference`, and the comments of the bundled reference.yaml."""

_PLAN = """examples:
  swarm plan quickstart
  swarm plan my.yaml --seed 3 --set agents.deployment.radius_m=5
  swarm plan quickstart --processes                  which processes a launch would start

Prints the agents with their system ids, layers and starting places, the phases, the coverage floor
1 - (1 - A_sensed / A_arena) ^ agents, and every setting beside its default. Flies nothing."""

_SCHEMA = """example:
  swarm schema > mission.schema.json

and as the first line of a mission file, for editors that speak yaml-language-server:
  # yaml-language-server: $schema=mission.schema.json"""


def _add_check(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("missions", nargs="+", metavar="MISSION", help=mission_help())
    add_set(parser)


def _check(options: argparse.Namespace) -> int:
    """Say of every mission that it is ok, or all that is wrong with it."""
    from missions.targets import herd

    code = DONE
    for name in options.missions:
        try:
            mission = load_mission(name, overrides=changes(options.set))
            herd(mission)  # reads the tracks, if there are any
        except InputError as error:
            sys.stderr.write(f"{error}\n")
            code = BAD_INPUT
        else:
            sys.stdout.write(f"{name}: ok ({mission.agents.count} agents, {mission.targets.motion} targets)\n")
    return code


def _add_plan(parser: argparse.ArgumentParser) -> None:
    add_mission(parser)
    add_processes(parser)


def _plan(options: argparse.Namespace) -> int:
    """Print what a mission would run."""
    mission = mission_of(options)
    from rich.console import Console

    from missions.plan import plan_mission, print_plan

    # Away from a terminal the output is the same everywhere: no colors, no wrapping.
    terminal = sys.stdout.isatty()
    console = Console(
        width=None if terminal else _NEVER_WRAP,
        color_system="auto" if terminal else None,
        markup=False,
        emoji=False,
        highlight=False,
    )
    with console.capture() as printed:
        print_plan(plan_mission(mission), console)
        if options.processes:
            from missions.daemons.processes import process_table
            from missions.daemons.verbs import processes

            console.print()
            console.print(process_table(processes(mission, options)))
    sys.stdout.writelines(f"{line.rstrip()}\n" for line in printed.get().splitlines())
    return DONE


def _schema(options: argparse.Namespace) -> int:
    """Print the JSON Schema of missions."""
    from missions.schema import mission_schema

    sys.stdout.write(json.dumps(mission_schema(), indent=2) + "\n")
    return DONE


CHECK = Command(name="check", summary="validate missions", examples=_CHECK, add_options=_add_check, run=_check)
PLAN = Command(name="plan", summary="show what a mission would run", examples=_PLAN, add_options=_add_plan, run=_plan)
SCHEMA = Command(
    name="schema",
    summary="print the JSON Schema of missions, for editors",
    examples=_SCHEMA,
    add_options=lambda parser: None,
    run=_schema,
)
