"""The flavors of simulated autopilots, by name."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot import parameter_protocol
from vehicle_sim.autopilot.commands import COMMANDS, set_mode
from vehicle_sim.autopilot.copter import Copter
from vehicle_sim.autopilot.courtesies import ANSWERS
from vehicle_sim.autopilot.flavor import Flavor
from vehicle_sim.autopilot.hearing import HEARING
from vehicle_sim.autopilot.px4.flavor import PX4
from vehicle_sim.autopilot.streams import GROUPS, UNASKED_S
from vehicle_sim.autopilot.telemetry import BUILDERS
from vehicle_sim.vehicle import FlavorName


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

FLAVORS: dict[FlavorName, Flavor] = {"ardupilot": ARDUPILOT, "px4": PX4}
