"""`swarm world`, `agent`, `record`: a mission's processes, one by one; `swarm keys`: by what they know each other."""

from __future__ import annotations

import argparse

from missions.commands.command import Command, need_extra
from missions.commands.which import add_mission, mission_of
from missions.daemons import arguments


def _add_world(parser: argparse.ArgumentParser) -> None:
    arguments.world_options(parser)
    add_mission(parser)


def _world(options: argparse.Namespace) -> int:
    from missions.daemons import verbs

    return verbs.world(mission_of(options), options)


def _add_agent(parser: argparse.ArgumentParser) -> None:
    arguments.agent_options(parser)
    add_mission(parser)


def _agent(options: argparse.Namespace) -> int:
    from missions.daemons import verbs

    return verbs.agent(mission_of(options), options)


def _add_record(parser: argparse.ArgumentParser) -> None:
    arguments.record_options(parser)
    add_mission(parser)


def _record(options: argparse.Namespace) -> int:
    from missions.daemons import verbs

    return verbs.record(mission_of(options), options)


def _keys(options: argparse.Namespace) -> int:
    need_extra("keys", "ground", ("cryptography",))
    from missions.daemons import verbs

    return verbs.issue(options)


WORLD = Command(
    name="world",
    summary="run a mission's world for other processes",
    examples=arguments.WORLD,
    add_options=_add_world,
    run=_world,
)
AGENT = Command(
    name="agent",
    summary="run one agent of a mission, or several",
    examples=arguments.AGENT,
    add_options=_add_agent,
    run=_agent,
)
RECORD = Command(
    name="record",
    summary="record a mission of other processes",
    examples=arguments.RECORD,
    add_options=_add_record,
    run=_record,
)
KEYS = Command(
    name="keys",
    summary="make credentials, so that nobody else can take part",
    examples=arguments.KEYS,
    add_options=arguments.add_issue,
    run=_keys,
)
