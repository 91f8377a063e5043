"""The verbs of the command line, one `Command` each, in the order in which `swarm --help` shows them.

flying    launch                                  looking   check, plan, schema
daemons   world, agent, record, keys              logs      review, import
fleet     status, hold, resume, return, ...       sim       one vehicle
study     study, train                            which     what names a mission, and what changes it

A verb imports what it runs when it runs, so that `swarm check` starts at once.
"""

from missions.commands import daemons, fleet, flying, logs, looking, sim, study
from missions.commands.command import Command

COMMANDS: tuple[Command, ...] = (
    flying.LAUNCH,
    daemons.WORLD,
    daemons.AGENT,
    *fleet.FLEET,
    daemons.RECORD,
    daemons.KEYS,
    looking.CHECK,
    looking.PLAN,
    sim.SIM,
    logs.REVIEW,
    logs.IMPORT,
    study.STUDY,
    study.TRAIN,
    looking.SCHEMA,
)
