"""The command line: `swarm VERB ...`. Each verb is a function of its arguments that returns an exit code.

Exit codes: 0 done, 1 the mission failed, 2 bad input, 130 stopped by Ctrl-C. Mistakes in a mission go to standard
error, one line each. A verb imports what it runs when it runs, so that `swarm check` starts at once.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Callable, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from missions.arguments import count, new_file, report, whole
from missions.daemons.arguments import (
    AGENT,
    FLEET,
    KEYS,
    RECORD,
    WORLD,
    add_fleet,
    add_issue,
    add_processes,
    add_speed,
    agent_options,
    fleet_examples,
    record_options,
    world_options,
)
from missions.load import LIBRARY, bundled_names, load_mission
from missions.mission import Mission
from missions.options import LaunchOptions, speed_of
from missions.overrides import Override
from missions.problems import InputError
from missions.review.options import EXAMPLES as REVIEW_EXAMPLES
from missions.review.options import add_options as add_review_options
from missions.review.options import review_options
from missions.sim.options import EXAMPLES as SIM_EXAMPLES
from missions.sim.options import add_options as add_sim_options
from missions.sim.options import link, signing_key, sim_options

if TYPE_CHECKING:
    from missions.study.shards import Shard

DONE, FAILED, BAD_INPUT, STOPPED = 0, 1, 2, 130

Verb = Callable[[argparse.Namespace], int]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command line (without the program's name; default: the process's own) and return its exit code."""
    try:
        options = _parser().parse_args(_joined(sys.argv[1:] if arguments is None else arguments))
    except SystemExit as stop:  # argparse has printed help or what is wrong
        return stop.code if isinstance(stop.code, int) else BAD_INPUT
    verb: Verb = options.verb
    try:
        return verb(options)
    except InputError as error:
        sys.stderr.write(f"{error}\n")
        return BAD_INPUT
    except KeyboardInterrupt:
        return STOPPED


def _joined(arguments: Sequence[str]) -> list[str]:
    """`--home -35.4,149.2,584,0` as `--home=-35.4,...`: argparse takes what begins with a minus for another option."""
    joined: list[str] = []
    for word in arguments:
        if re.match(r"-[\d.]", word) and joined and re.fullmatch(r"--[a-z-]+", joined[-1]):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def launch(options: argparse.Namespace) -> int:
    """Fly a mission."""
    mission = _mission(options)
    if options.processes:
        from missions.daemons import verbs

        return verbs.launch(mission, options)
    from missions.launch import launch as fly

    speed = speed_of(mission, options.speed)
    settings = LaunchOptions(
        speed=speed,
        record=options.record,
        tlog=options.tlog,
        report=options.report,
        view=options.view,
        web=options.web,
        gcs=tuple(options.gcs),
        gcs_key=options.gcs_signing_key,
    )
    return fly(mission, options=settings)


def record(options: argparse.Namespace) -> int:
    """Record a mission that other processes fly."""
    from missions.daemons import verbs

    return verbs.record(_mission(options), options)


def world(options: argparse.Namespace) -> int:
    """Run a mission's world for agents in other processes."""
    from missions.daemons import verbs

    return verbs.world(_mission(options), options)


def agent(options: argparse.Namespace) -> int:
    """Run some of a mission's agents."""
    from missions.daemons import verbs

    return verbs.agent(_mission(options), options)


def fleet(verb: str, options: argparse.Namespace) -> int:
    """Tell vehicles that are under way, or ask them."""
    from missions.daemons import verbs

    return verbs.fleet(verb, options)


def keys(options: argparse.Namespace) -> int:
    """Make the credentials of a swarm."""
    _need_extra("keys", "ground", ("cryptography",))
    from missions.daemons import verbs

    return verbs.issue(options)


def check(options: argparse.Namespace) -> int:
    """Say of every mission that it is ok, or all that is wrong with it."""
    from missions.targets import herd

    code = DONE
    for name in options.missions:
        try:
            mission = load_mission(name, overrides=_overrides(options))
            herd(mission)  # reads the tracks, if there are any
        except InputError as error:
            sys.stderr.write(f"{error}\n")
            code = BAD_INPUT
        else:
            sys.stdout.write(f"{name}: ok ({mission.agents.count} agents, {mission.targets.motion} targets)\n")
    return code


def plan(options: argparse.Namespace) -> int:
    """Print what a mission would run."""
    mission = _mission(options)
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


def schema(options: argparse.Namespace) -> int:
    """Print the JSON Schema of missions."""
    from missions.schema import mission_schema

    sys.stdout.write(json.dumps(mission_schema(), indent=2) + "\n")
    return DONE


def sim(options: argparse.Namespace) -> int:
    """Fly one vehicle in real time for whoever connects."""
    from missions.sim.session import simulate

    return simulate(sim_options(options))


def review(options: argparse.Namespace) -> int:
    """Tell what happened in a mission, from its recording."""
    _need_extra("review", "ground", _REVIEW_PACKAGES)
    from missions.review.command import review as tell

    return tell(review_options(options))


def import_(options: argparse.Namespace) -> int:
    """Make a recording of flight logs."""
    _need_extra("import", "ground", _REVIEW_PACKAGES)
    from missions.conversion import import_logs

    import_logs(options.logs, options.to)
    return DONE


def study(options: argparse.Namespace) -> int:
    """Fly a study, all of the paper's, or merge what several computers have flown."""
    _need_extra("study", "study", _STUDY_PACKAGES)
    from missions.study.command import StudyOptions, fly_paper, fly_study, merge
    from missions.study.shards import WHOLE

    name, *folders = options.study
    if name == "merge" and folders:
        return merge([Path(folder) for folder in folders], options.out)
    if folders or name == "merge":
        allowed = "one study, paper, or merge and the folders to merge"
        raise InputError(f'STUDY: got "{" ".join(options.study)}"; allowed: {allowed}')
    settings = StudyOptions(
        runs=options.runs,
        seed=options.seed,
        policies=tuple(options.policy),
        overrides=tuple(_overrides(argparse.Namespace(set=options.set))),
        out=options.out,
        shard=options.shard or WHOLE,
        dask=options.dask,
        fresh=options.fresh,
        threads=options.threads,
    )
    return fly_paper(settings) if name == "paper" else fly_study(name, settings)


def train(options: argparse.Namespace) -> int:
    """Fit the learned predictor to study runs, and write its weights."""
    _need_extra("train", "study", _TRAIN_PACKAGES)
    from rich.console import Console

    from missions.training.train import train as fit

    console = Console(soft_wrap=True, markup=False, emoji=False, highlight=False)
    overrides = _overrides(argparse.Namespace(set=options.set))
    fit(options.mission, runs=options.runs, seed=options.seed, out=options.out, overrides=overrides, console=console)
    return DONE


def _need_extra(verb: str, extra: str, packages: Sequence[str]) -> None:
    missing = [name for name in packages if find_spec(name) is None]
    if missing:
        need = f"swarm {verb} needs the `{extra}` extra: pip install 'swarm-mission-stack[{extra}]'"
        raise InputError(f"{need} (no module {missing[0]!r})")


_NEVER_WRAP = 1000
_REVIEW_PACKAGES = ("numpy", "rerun", "matplotlib")
_STUDY_PACKAGES = ("numpy", "numba", "pyarrow", "matplotlib")
_TRAIN_PACKAGES = ("numpy", "numba", "torch")

_TOP = """examples:
  swarm launch quickstart              fly ten agents over ten targets
  swarm launch quickstart --set agents.count=5 --report -
  swarm check my.yaml                  every mistake, with line, key and what is allowed
  swarm plan wildlife                  what would run, as tables
  swarm review out/q.rrd               what happened in a recorded mission, and why
  swarm sim --port 5760                one vehicle for QGroundControl, MAVProxy or MAVSDK
  swarm study figure-16 --runs 20      many missions, compared

`swarm VERB --help` tells more. Exit codes: 0 done, 1 the mission failed, 2 bad input, 130 stopped by Ctrl-C."""

_LAUNCH = """examples:
  swarm launch quickstart --record out/q.rrd --report out/q.json
  swarm launch narrow --seed 7 --duration 60 --processes              a process for each agent
  swarm launch quickstart --speed 1 --gcs udpout:127.0.0.1:14550      watched by a ground station
  swarm launch narrow --tlog out/logs; mavlogdump.py out/logs/agent-0.tlog
  swarm launch my.yaml --set radio.loss=0.3 --set 'targets={motion: static, count: 4}'"""

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

_IMPORT = """examples:
  swarm import flight.tlog --to out/flight.rrd         a log of MAVProxy or QGroundControl
  swarm import out/logs/*.tlog --to out/swarm.rrd      what swarm launch --tlog out/logs kept, all vehicles in one

Look at it with rerun. A run of a study needs no import: swarm launch MISSION --set vehicle.kind=ideal --seed N
--record F.rrd flies and records the very same."""

_SCHEMA = """example:
  swarm schema > mission.schema.json

and as the first line of a mission file, for editors that speak yaml-language-server:
  # yaml-language-server: $schema=mission.schema.json"""


_STUDY = """examples:
  swarm study figure-16 --runs 20      tables, figures and claims in out/study/figure-16/
  swarm study paper                    every experiment of the paper, and a page over all of them
  swarm study my.yaml --policy b-cmommt --set duration_s=60 --out out/mine
  swarm study my.yaml --shard 2/4 --out part2; swarm study merge part1 part2 part3 part4 --out all
  swarm study my.yaml --dask tcp://10.0.0.5:8786

A study that is stopped goes on where it was when it is started again."""

_TRAIN = """examples:
  swarm train                          50 runs, as in the paper
  swarm train --runs 400 --out my.json
  swarm train my.yaml --set agents.sensing.range_m=4 --out short.json
  swarm launch quickstart --set policy.predictor=learned --set policy.weights=my.json

Flies the mission once for every seed, by the policy as the paper prints it; finds the situations in which one agent
has two (three) targets until it loses one and nobody interferes; fits a net for two tags and one for three. Every fifth
run is held out. Prints rows and errors beside the paper's and those of eq. 10."""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="swarm",
        description="Fly a swarm of MAVLink drones that keeps moving targets in sight.",
        epilog=_TOP,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"%(prog)s {_version()}")
    verbs = parser.add_subparsers(title="verbs", metavar="VERB", required=True)

    flying = _verb(verbs, "launch", launch, "fly a mission", _LAUNCH)
    flying.usage = "swarm launch MISSION [options]"  # too many to name them twice
    _one_mission(flying)
    add_speed(flying)
    flying.add_argument("--record", type=new_file, metavar="F.rrd", help="write a recording for rerun")
    flying.add_argument("--tlog", type=Path, metavar="DIR", help="write a log of each link, for MAVProxy")
    flying.add_argument("--report", type=report, metavar="F.json", help="write the report; - is standard output")
    flying.add_argument(
        "--gcs",
        type=link,
        action="append",
        default=[],
        metavar="URL",
        help="show the swarm to ground stations; may be repeated",
    )
    flying.add_argument(
        "--gcs-signing-key",
        type=signing_key,
        metavar="FILE",
        help="sign these links, with the key in FILE",
    )
    flying.add_argument("--view", action="store_true", help="open a viewer and watch")
    flying.add_argument("--web", action="store_true", help="serve a viewer to browsers on this computer")
    add_processes(flying)

    _one_mission(world_options(_verb(verbs, "world", world, "run a mission's world for other processes", WORLD)))
    _one_mission(agent_options(_verb(verbs, "agent", agent, "run one agent of a mission, or several", AGENT)))
    for name, about in FLEET.items():
        add_fleet(_verb(verbs, name, partial(fleet, name), about, fleet_examples(name)))
    _one_mission(record_options(_verb(verbs, "record", record, "record a mission of other processes", RECORD)))

    add_issue(_verb(verbs, "keys", keys, "make credentials, so that nobody else can take part", KEYS))

    checking = _verb(verbs, "check", check, "validate missions", _CHECK)
    checking.add_argument("missions", nargs="+", metavar="MISSION", help=_mission_help())
    _add_set(checking)

    planning = _verb(verbs, "plan", plan, "show what a mission would run", _PLAN)
    _one_mission(planning)
    add_processes(planning)

    add_sim_options(_verb(verbs, "sim", sim, "fly one vehicle in real time, as ArduCopter SITL does", SIM_EXAMPLES))

    add_review_options(_verb(verbs, "review", review, "tell what happened, from a recording", REVIEW_EXAMPLES))

    importing = _verb(verbs, "import", import_, "make a recording of flight logs", _IMPORT)
    importing.add_argument("logs", nargs="+", type=Path, metavar="F.tlog", help="a telemetry log")
    importing.add_argument("--to", type=new_file, required=True, metavar="F.rrd", help="the recording to write")

    _add_study(_verb(verbs, "study", study, "fly many missions and compare them", _STUDY))

    _add_train(_verb(verbs, "train", train, "fit the learned predictor", _TRAIN))

    _verb(verbs, "schema", schema, "print the JSON Schema of missions, for editors", _SCHEMA)
    return parser


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("swarm-mission-stack")
    except PackageNotFoundError:
        return "(not installed)"


def _verb(
    verbs: argparse._SubParsersAction[argparse.ArgumentParser], name: str, verb: Verb, summary: str, epilog: str
) -> argparse.ArgumentParser:
    parser = verbs.add_parser(
        name,
        help=summary,
        description=f"{summary[0].upper()}{summary[1:]}.",
        epilog=epilog,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.set_defaults(verb=verb)
    return parser


def _one_mission(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("mission", metavar="MISSION", help=_mission_help())
    parser.add_argument("--seed", metavar="N", help="another seed: the same as --set seed=N")
    parser.add_argument("--duration", metavar="S", help="another duration: the same as --set duration_s=S")
    _add_set(parser)


def _add_set(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="another value, written as YAML, for one key of the mission; may be repeated",
    )


def _add_study(parser: argparse.ArgumentParser) -> None:
    studies = sorted(path.stem for path in (LIBRARY / "studies").glob("*.yaml"))
    about = f"path of a study file, a bundled study ({', '.join(studies)}), paper, or merge DIR..."
    parser.add_argument("study", nargs="+", metavar="STUDY", help=about)
    parser.add_argument("--runs", type=count, metavar="N", help="fly every point N times")
    parser.add_argument("--seed", type=whole, metavar="N", help="the first run's seed; the next run has the next")
    parser.add_argument(
        "--policy", action="append", default=[], metavar="P", help="fly this policy, and not all; may be repeated"
    )
    _add_set(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="the folder of the results")
    parser.add_argument("--fresh", action="store_true", help="throw away what the folder holds, and fly all again")
    parser.add_argument("--shard", type=_shard, metavar="i/N", help="fly part i of N alone")
    parser.add_argument("--dask", metavar="ADDRESS", help="fly on the Dask cluster whose scheduler is there")
    parser.add_argument("--threads", type=count, metavar="N", help="use so many cores, and not all")


def _add_train(parser: argparse.ArgumentParser) -> None:
    about = f"{_mission_help()}; quickstart unless given"
    parser.add_argument("mission", nargs="?", default="quickstart", metavar="MISSION", help=about)
    parser.add_argument("--runs", type=count, default=50, metavar="N", help="learn from N runs (default: 50)")
    parser.add_argument("--seed", type=whole, default=1, metavar="N", help="the first run's seed, and the fit's")
    _add_set(parser)
    parser.add_argument(
        "--out", type=new_file, default=Path("weights.json"), metavar="F.json", help="the file of weights to write"
    )


def _mission_help() -> str:
    return f"path of a mission file, or a bundled mission: {', '.join(bundled_names())}"


def _mission(options: argparse.Namespace) -> Mission:
    return load_mission(options.mission, overrides=_overrides(options))


def _overrides(options: argparse.Namespace) -> list[Override]:
    given = vars(options)
    shortcuts = (("--seed", "seed", given.get("seed")), ("--duration", "duration_s", given.get("duration")))
    own = [Override(f"{key}={text}", option) for option, key, text in shortcuts if text is not None]
    return [*(Override(text) for text in options.set), *own]


def _shard(text: str) -> Shard:
    from missions.study.shards import Shard

    index, _, count = text.partition("/")
    if not (index.isdigit() and count.isdigit() and 1 <= int(index) <= int(count)):
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: i/N with i from 1 to N, such as 2/4')
    return Shard(int(index), int(count))


if __name__ == "__main__":
    sys.exit(main())
