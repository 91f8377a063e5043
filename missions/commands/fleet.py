"""`swarm status`, `hold`, `resume`, `return`, `land`, `stop`: people speak to vehicles that are under way."""

from __future__ import annotations

from functools import partial

from missions.commands.command import Command
from missions.daemons import verbs
from missions.daemons.arguments import FLEET as VERBS
from missions.daemons.arguments import add_fleet, fleet_examples

FLEET = tuple(
    Command(
        name=name,
        summary=about,
        examples=fleet_examples(name),
        add_options=add_fleet,
        run=partial(verbs.fleet, name),
    )
    for name, about in VERBS.items()
)
