"""An ArduCopter, as a row of the table of flavors."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.ardupilot import parameter_protocol
from vehicle_sim.autopilot.ardupilot.commands import COMMANDS, set_mode
from vehicle_sim.autopilot.ardupilot.copter import Copter
from vehicle_sim.autopilot.ardupilot.hearing import HEARING
from vehicle_sim.autopilot.ardupilot.streams import GROUPS
from vehicle_sim.autopilot.ardupilot.telemetry import BUILDERS
from vehicle_sim.autopilot.courtesies import ANSWERS
from vehicle_sim.autopilot.flavor import Flavor
from vehicle_sim.autopilot.streams import UNASKED_S


def addressed(message: Any, system_id: int) -> bool:
    """For this system or for everybody; the component does not matter, as on a real ArduCopter."""
    return getattr(message, "target_system", 0) in (0, system_id)


ARDUPILOT = Flavor(
    autopilot=Copter,
    builders=BUILDERS,
    unasked_s=UNASKED_S,
    groups=GROUPS,
    commands=COMMANDS,
    set_mode=set_mode,
    set_mode_ack=dialect.MAVLINK_MSG_ID_SET_MODE,
    addressed=addressed,
    hearing=HEARING,
    answers=ANSWERS
    | {
        dialect.MAVLINK_MSG_ID_PARAM_REQUEST_READ: parameter_protocol.read,
        dialect.MAVLINK_MSG_ID_PARAM_REQUEST_LIST: parameter_protocol.listed,
        dialect.MAVLINK_MSG_ID_PARAM_SET: parameter_protocol.written,
    },
)
