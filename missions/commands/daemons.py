"""`swarm world`, `agent`, `record`: a mission's processes, one by one; `swarm keys`: by what they know each other."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from missions.commands.command import Command, need_extra
from missions.commands.which import add_mission, mission_of
from missions.daemons import arguments, verbs
from missions.mission import Mission

Parser = argparse.ArgumentParser


def _process(
    name: str,
    summary: str,
    examples: str,
    add_options: Callable[[Parser], Parser],
    run: Callable[[Mission, argparse.Namespace], int],
) -> Command:
    """The verb of one process of a mission."""
    return Command(
        name=name,
        summary=summary,
        examples=examples,
        add_options=lambda parser: add_mission(add_options(parser)),
        run=lambda options: run(mission_of(options), options),
    )


def _keys(options: argparse.Namespace) -> int:
    need_extra("keys", "ground", ("cryptography",))
    return verbs.issue(options)


WORLD = _process(
    "world",
    "run a mission's world for other processes",
    arguments.WORLD,
    arguments.world_options,
    verbs.world,
)
AGENT = _process(
    "agent",
    "run one agent of a mission, or several",
    arguments.AGENT,
    arguments.agent_options,
    verbs.agent,
)
RECORD = _process(
    "record",
    "record a mission of other processes",
    arguments.RECORD,
    arguments.record_options,
    verbs.record,
)
KEYS = Command(
    name="keys",
    summary="make credentials, so that nobody else can take part",
    examples=arguments.KEYS,
    add_options=arguments.add_issue,
    run=_keys,
)
