"""What a vehicle can be asked for, and how its answers are recognized. Raw command numbers stay here."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import isfinite
from typing import Protocol

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.mavlink import Message
from swarm_agent.autopilot.flavors import AltitudeParameter, Mode

AUTOPILOT_COMPONENT_ID = dialect.MAV_COMP_ID_AUTOPILOT1
FORCE_NOTHING = 0.0
LARGEST_NUMBER = 1e7  # ids, microseconds and meters all stay below; a number beyond has crashed real autopilots


class Answer(Enum):
    """What an autopilot says to a request."""

    ACCEPTED = "accepted"
    IN_PROGRESS = "in progress"
    REFUSED = "refused"  # not now: worth asking again
    UNSUPPORTED = "not supported"  # never: do not ask again


ANSWERS = {
    dialect.MAV_RESULT_ACCEPTED: Answer.ACCEPTED,
    dialect.MAV_RESULT_IN_PROGRESS: Answer.IN_PROGRESS,
    dialect.MAV_RESULT_UNSUPPORTED: Answer.UNSUPPORTED,
}


class Request(Protocol):
    """Something to send until it is answered."""

    @property
    def name(self) -> str:
        """What is asked, for people: "arm"."""

    def message(self, *, system_id: int, repeat: int) -> Message:
        """The message to send to `system_id`, for the `repeat`-th time (from 0)."""

    def answer_in(self, reply: Message) -> Answer | None:
        """The answer to this request that `reply` holds, if it holds one."""


@dataclass(frozen=True, slots=True)
class Command:
    """A COMMAND_LONG to the autopilot, answered by COMMAND_ACK.

    Raises:
        ValueError: a parameter is not finite or beyond `LARGEST_NUMBER` (a bug of the caller: it must not leave).
    """

    name: str
    command: int
    parameters: tuple[float, ...]

    def __post_init__(self) -> None:
        if not all(isfinite(value) and abs(value) <= LARGEST_NUMBER for value in self.parameters):
            raise ValueError(f"{self.name}: {self.parameters} holds a number no vehicle may be sent")

    def message(self, *, system_id: int, repeat: int) -> Message:
        """COMMAND_LONG, its `confirmation` counting the repeats."""
        numbers = (*self.parameters, *(0.0,) * (7 - len(self.parameters)))
        return dialect.MAVLink_command_long_message(
            system_id, AUTOPILOT_COMPONENT_ID, self.command, min(repeat, 255), *numbers
        )

    def answer_in(self, reply: Message) -> Answer | None:
        """The result, from a COMMAND_ACK for this command."""
        if reply.get_msgId() != dialect.MAVLINK_MSG_ID_COMMAND_ACK or reply.command != self.command:
            return None
        return ANSWERS.get(reply.result, Answer.REFUSED)


@dataclass(frozen=True, slots=True)
class WriteAltitude:
    """A PARAM_SET of an altitude, answered by the PARAM_VALUE the vehicle has stored."""

    parameter: AltitudeParameter
    altitude_m: float

    @property
    def name(self) -> str:
        """Names the parameter and the value, in the vehicle's units."""
        return f"set {self.parameter.name} to {self._value:g}"

    @property
    def _value(self) -> float:
        return round(self.altitude_m * self.parameter.units_per_m, 2 if self.parameter.units_per_m == 1.0 else 0)

    def message(self, *, system_id: int, repeat: int) -> Message:
        """PARAM_SET; values travel C-cast to float."""
        parameter = self.parameter
        return dialect.MAVLink_param_set_message(
            system_id, AUTOPILOT_COMPONENT_ID, parameter.name.encode(), self._value, parameter.type
        )

    def answer_in(self, reply: Message) -> Answer | None:
        """Accepted if a PARAM_VALUE says that the value is stored, to a centimeter; refused if another one is."""
        if reply.get_msgId() == dialect.MAVLINK_MSG_ID_PARAM_ERROR:
            return Answer.UNSUPPORTED if reply.param_id == self.parameter.name else None
        if reply.get_msgId() != dialect.MAVLINK_MSG_ID_PARAM_VALUE or reply.param_id != self.parameter.name:
            return None
        error_m = abs(reply.param_value - self._value) / self.parameter.units_per_m
        return Answer.ACCEPTED if error_m < 0.01 else Answer.REFUSED


def set_mode(mode: Mode) -> Command:
    """Fly in this mode."""
    custom_enabled = float(dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED)
    return Command(f"mode {mode.name}", dialect.MAV_CMD_DO_SET_MODE, (custom_enabled, *mode.asked_with))


def arm() -> Command:
    """Start the motors; never by force."""
    return Command("arm", dialect.MAV_CMD_COMPONENT_ARM_DISARM, (1.0, FORCE_NOTHING))


def disarm() -> Command:
    """Stop the motors; never by force, so a vehicle in the air refuses."""
    return Command("disarm", dialect.MAV_CMD_COMPONENT_ARM_DISARM, (0.0, FORCE_NOTHING))


def take_off(altitude_m: float) -> Command:
    """Climb to `altitude_m`, counted as the vehicle's flavor says."""
    return Command(f"takeoff to {altitude_m:.1f} m", dialect.MAV_CMD_NAV_TAKEOFF, (0.0,) * 6 + (altitude_m,))


def stream(message_id: int, rate_hz: float) -> Command:
    """Send this message at this rate."""
    microseconds = 1e6 / rate_hz
    return Command(
        f"message {message_id} at {rate_hz:g} Hz",
        dialect.MAV_CMD_SET_MESSAGE_INTERVAL,
        (float(message_id), microseconds),
    )


def tell_origin() -> Command:
    """Send GPS_GLOBAL_ORIGIN once."""
    return Command("origin", dialect.MAV_CMD_REQUEST_MESSAGE, (float(dialect.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN),))
