"""`swarm launch`: fly a mission, in one process or in many."""

from __future__ import annotations

import argparse
from pathlib import Path

from missions.arguments import new_file, report
from missions.commands.command import Command
from missions.commands.which import add_mission, mission_of
from missions.daemons import verbs
from missions.daemons.arguments import add_processes, add_speed
from missions.options import LaunchOptions, speed_of
from missions.sim.options import link, signing_key

_EXAMPLES = """examples:
  swarm launch quickstart --record out/q.rrd --report out/q.json
  swarm launch narrow --seed 7 --duration 60 --processes              a process for each agent
  swarm launch quickstart --speed 1                                   in another terminal: swarm status, hold, land
  swarm launch quickstart --speed 1 --gcs udpout:127.0.0.1:14550      watched by a ground station
  swarm launch narrow --tlog out/logs; mavlogdump.py out/logs/agent-0.tlog
  swarm launch my.yaml --set radio.loss=0.3 --set 'targets={motion: static, count: 4}'"""


def _add_options(parser: argparse.ArgumentParser) -> None:
    add_mission(parser)
    add_speed(parser)
    add = parser.add_argument
    add("--record", type=new_file, metavar="F.rrd", help="write a recording for rerun")
    add("--tlog", type=Path, metavar="DIR", help="write a log of each link, for MAVProxy")
    add("--report", type=report, metavar="F.json", help="write the report; - is standard output")
    about = "show the swarm to ground stations; may be repeated"
    add("--gcs", type=link, action="append", default=[], metavar="URL", help=about)
    add("--gcs-signing-key", type=signing_key, metavar="FILE", help="sign these links, with the key in FILE")
    add("--view", action="store_true", help="open a viewer and watch")
    add("--web", action="store_true", help="serve a viewer to browsers on this computer")
    add_processes(parser)


def _launch(options: argparse.Namespace) -> int:
    mission = mission_of(options)
    if options.processes:
        return verbs.launch(mission, options)
    from missions.launch import launch as fly

    speed = speed_of(mission, options.speed)
    settings = LaunchOptions(
        speed=speed,
        board=verbs.board(options, speed=speed),
        record=options.record,
        tlog=options.tlog,
        report=options.report,
        view=options.view,
        web=options.web,
        gcs=tuple(options.gcs),
        gcs_key=options.gcs_signing_key,
    )
    return fly(mission, options=settings)


LAUNCH = Command(
    name="launch",
    summary="fly a mission",
    examples=_EXAMPLES,
    add_options=_add_options,
    run=_launch,
    usage="swarm launch MISSION [options]",
)
