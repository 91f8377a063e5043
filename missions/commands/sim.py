"""`swarm sim`: one vehicle in real time, for whoever connects."""

from __future__ import annotations

import argparse

from missions.commands.command import Command
from missions.sim.options import EXAMPLES, add_options, sim_options


def _sim(options: argparse.Namespace) -> int:
    from missions.sim.session import simulate

    return simulate(sim_options(options))


SIM = Command(
    name="sim",
    summary="fly one vehicle in real time, as ArduCopter SITL does",
    examples=EXAMPLES,
    add_options=add_options,
    run=_sim,
)
