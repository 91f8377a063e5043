"""A PX4, as a row of the table of flavors."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.courtesies import ANSWERS
from vehicle_sim.autopilot.flavor import Flavor
from vehicle_sim.autopilot.px4 import parameter_protocol
from vehicle_sim.autopilot.px4.commander import Commander
from vehicle_sim.autopilot.px4.commands import COMMANDS, set_mode
from vehicle_sim.autopilot.px4.hearing import HEARING
from vehicle_sim.autopilot.px4.streams import UNASKED_S
from vehicle_sim.autopilot.px4.telemetry import BUILDERS

AUTOPILOT, EVERY_COMPONENT = 1, 0
DO_SET_MODE = 176
REQUEST_MESSAGE = 512  # the one command for everybody, and for any component
COMMANDS_TAKEN = frozenset({dialect.MAVLINK_MSG_ID_COMMAND_INT, dialect.MAVLINK_MSG_ID_COMMAND_LONG})


def addressed(message: Any, system_id: int) -> bool:
    """For this system, and for the autopilot or all components; hardly a command is for everybody."""
    system = getattr(message, "target_system", None)
    if system is None:
        return True
    is_command = message.get_msgId() in COMMANDS_TAKEN
    if is_command and message.command == REQUEST_MESSAGE:
        return system in (0, system_id)
    component = getattr(message, "target_component", EVERY_COMPONENT)
    here = system == system_id or (system == 0 and not is_command)
    return here and component in (AUTOPILOT, EVERY_COMPONENT)


PX4 = Flavor(
    autopilot=Commander,
    builders=BUILDERS,
    unasked_s=UNASKED_S,
    groups={},
    commands=COMMANDS,
    set_mode=set_mode,
    set_mode_ack=DO_SET_MODE,
    addressed=addressed,
    hearing=HEARING,
    answers=ANSWERS
    | {
        dialect.MAVLINK_MSG_ID_PARAM_REQUEST_READ: parameter_protocol.read,
        dialect.MAVLINK_MSG_ID_PARAM_REQUEST_LIST: parameter_protocol.listed,
        dialect.MAVLINK_MSG_ID_PARAM_SET: parameter_protocol.written,
    },
)
