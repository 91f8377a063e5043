"""The command line's options of the verbs that run a mission in many processes."""

from __future__ import annotations

import argparse
from pathlib import Path

from comms.endpoint import place_of
from missions.arguments import count, new_file, report, seconds, speed, unix_time, whole
from missions.daemons.log import LEVELS
from missions.daemons.options import ENDPOINT, ENDPOINTS, JOIN_S

Parser = argparse.ArgumentParser

WORLD = """examples:
  swarm world quickstart --report out/q.json         then, in other terminals, swarm agent quickstart --id 0 ...
  swarm world my.yaml --listen tcp/0.0.0.0:7447 --keys keys      for agents on other hosts

Waits until every agent of the mission is there; then the mission begins. SIGTERM: everybody lands, then it exits 0."""

AGENT = """examples:
  swarm agent quickstart --id 3
  swarm agent quickstart --id 0-4                    five agents in one process
  swarm agent my.yaml --id 0 --connect tcp/10.0.0.5:7447 --keys keys
  swarm agent field.yaml --id 0 --alone              no world: then swarm resume, on the same computer (docs/field.md)

The mission, what changes it, and --speed must be the world's, and so is the end. SIGTERM: fly home, land, exit 0; a
second one: at once. Who hears no world holds still for agents.world_timeout_s, and then flies home: code 1."""

RECORD = """examples:
  swarm record quickstart --record out/q.rrd
  swarm record quickstart --view                     look on

Start it before the last agent, or begin the world with --recorded: it records from when it is there until the mission
is over. SIGTERM: the recording ends there, whole, and the code is 0."""

KEYS = """examples:
  swarm keys keys --agents 10
  swarm launch quickstart --processes --keys keys
  swarm status --keys keys
  swarm keys keys5 --agents 10 --per-process 5       for swarm agent --id 0-4 and --id 5-9

Who has agent-3.key can speak for agent 3 and for nobody else, sees nothing but its own sight, and commands nobody. Give
each computer authority.pem and the .pem and .key of its own name; the world's folder also holds the .pem of all whom it
lets in. The authority's own key is not kept: for more agents make all anew."""

# What each verb for vehicles under way does.
FLEET = {
    "status": "show how every vehicle is: a table, live on a terminal",
    "hold": "let vehicles stay where they are, watching",
    "resume": "let vehicles go on after a hold",
    "return": "bring vehicles home, and let the others go on",
    "land": "land vehicles where they are",
    "stop": "bring everybody home and end; with --id, an agent alone",
}


def fleet_examples(verb: str) -> str:
    """How the verb is used."""
    return f"""examples:
  swarm {verb}
  swarm {verb} quickstart --id 3
  swarm {verb} --connect tcp/10.0.0.5:7447 --keys keys

Speaks to a `swarm launch` that has --speed, --listen or --processes, to `swarm world` and its agents, and to
`swarm agent --alone`. Every vehicle answers for itself, and is asked three times; the code is 1 if any refuses, or
gives no answer."""


def world_options(parser: Parser) -> Parser:
    """Add what `swarm world` has."""
    add_speed(parser)
    parser.add_argument("--report", type=report, metavar="F.json", help="write the report; - is standard output")
    parser.add_argument("--recorded", action="store_true", help="wait for a recorder, too")
    _add_insecure(parser)
    return _add_daemon(parser, "--listen", "listen there")


def agent_options(parser: Parser) -> Parser:
    """Add what `swarm agent` has."""
    add_speed(parser)
    parser.add_argument("--id", required=True, metavar="N", help="its number from 0, or several: 0-4")
    about = f"without a world: listen there for people and detectors ({ENDPOINT}), in UTC, from swarm resume on"
    parser.add_argument("--alone", nargs="?", type=_endpoint, const=ENDPOINT, metavar="ENDPOINT", help=about)
    parser.add_argument("--tlog", type=Path, metavar="DIR", help="add to a log of each link there, for MAVProxy")
    about = "the mission clock's 0 there, in seconds since 1970"
    parser.add_argument("--tlog-began", type=unix_time, metavar="S", help=about)
    _add_insecure(parser)
    return _add_daemon(parser, "--connect", "where the world listens")


def record_options(parser: Parser) -> Parser:
    """Add what `swarm record` has."""
    add_speed(parser)
    parser.add_argument("--record", type=new_file, metavar="F.rrd", help="write a recording for rerun")
    parser.add_argument("--view", action="store_true", help="open a viewer and watch")
    parser.add_argument("--web", action="store_true", help="serve a viewer to browsers on this computer")
    return _add_daemon(parser, "--connect", "where the world listens")


def add_speed(parser: Parser) -> None:
    """Add how fast the mission's clock goes."""
    about = "X times real time, or max (default; with links: 1)"
    parser.add_argument("--speed", type=speed, metavar="X", help=about)


def add_processes(parser: Parser) -> None:
    """Add what a launch in many processes has."""
    about = "many processes; N agents in one (1)"
    parser.add_argument("--processes", nargs="?", type=count, const=1, metavar="N", help=about)
    about = f"where they meet, and people reach the mission ({ENDPOINT}; one process without --speed: nowhere)"
    parser.add_argument("--listen", type=_endpoint, metavar="ENDPOINT", help=about)
    parser.add_argument("--restarts", type=whole, default=3, metavar="N", help="of an agent's process that fails (3)")
    _add_keys(parser)
    _add_insecure(parser)
    _add_log_level(parser, default="error")


def _add_daemon(parser: Parser, where: str, about: str) -> Parser:
    about = f"{about} ({ENDPOINT})"
    parser.add_argument(where, dest="endpoint", type=_endpoint, default=ENDPOINT, metavar="ENDPOINT", help=about)
    about = f"wait so long for the others ({JOIN_S:g})"
    parser.add_argument("--join-timeout", type=seconds, default=JOIN_S, metavar="S", help=about)
    _add_keys(parser)
    _add_log_level(parser, default="info")
    parser.add_argument("--leash", action="store_true", help="end, as by SIGTERM, when standard input does")
    return parser


def _endpoint(text: str) -> str:
    if place_of(text) is None:
        raise argparse.ArgumentTypeError(f"got {text}; allowed: {ENDPOINTS}")
    return text


def _folder(text: str) -> Path:
    path = Path(text)
    if not path.is_dir():
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: a folder that `swarm keys` has made')
    return path


def _add_keys(parser: Parser) -> None:
    parser.add_argument("--keys", type=_folder, metavar="DIR", help="prove who it is by what `swarm keys` put there")


def _add_insecure(parser: Parser) -> None:
    parser.add_argument("--insecure", action="store_true", help="let in everybody, from other computers too")


def _add_log_level(parser: Parser, *, default: str) -> None:
    about = f"{', '.join(LEVELS)}: the least that is said ({default})"
    parser.add_argument(
        "--log-level", choices=[str(level) for level in LEVELS], default=default, metavar="LEVEL", help=about
    )


def add_fleet(parser: Parser) -> None:
    """Add what the verbs for vehicles under way have."""
    parser.add_argument("mission", nargs="?", metavar="MISSION", help="the mission's file or name; all there, if none")
    parser.add_argument("--id", metavar="N", help="this agent, or these: 0-4; everybody, if none")
    about = f"where the world listens ({ENDPOINT})"
    parser.add_argument("--connect", type=_endpoint, default=ENDPOINT, metavar="ENDPOINT", help=about)
    _add_keys(parser)


def add_issue(parser: Parser) -> None:
    """Add what `swarm keys` has."""
    parser.add_argument("folder", type=Path, metavar="DIR", help="the folder to make, which nobody else may read")
    parser.add_argument("--agents", type=count, default=10, metavar="N", help="for so many agents (10)")
    about = "agents in one process, as in launch --processes N (1)"
    parser.add_argument("--per-process", type=count, default=1, metavar="N", help=about)
    parser.add_argument("--force", action="store_true", help="throw away the credentials that are there")
