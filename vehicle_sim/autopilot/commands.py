"""The commands it takes (COMMAND_LONG and COMMAND_INT): a table of handlers, each of which answers with a MAV_RESULT.

Handlers are total: any float, NaN and infinities too, gives a result and never a surprise. What a handler wants to say
or send goes out behind the acknowledgement.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from math import isfinite
from typing import Any, NamedTuple

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.modes import Mode
from vehicle_sim.autopilot.severity import INFO
from vehicle_sim.autopilot.streams import Streams
from vehicle_sim.autopilot.telemetry import BUILDERS
from vehicle_sim.autopilot.telemetry.state import CUSTOM_MODE

FORCE_ARM, FORCE_DISARM = 2989.0, 21196.0
MISSION_CURRENT_ID = 42
LONGEST_PERIOD_US = 2**31 - 1


class Result(IntEnum):
    """MAV_RESULT."""

    ACCEPTED = 0
    DENIED = 2
    UNSUPPORTED = 3
    FAILED = 4


class Request(NamedTuple):
    """A command on its way: who it acts on, its seven parameters, and where answers wait for the acknowledgement."""

    pilot: Autopilot
    streams: Streams
    params: tuple[float, ...]
    replies: list[Any]

    def number(self, index: int) -> int:
        """Parameter `index` (from 1) as an integer; -1 if it is none."""
        value = self.params[index - 1]
        return int(value) if isfinite(value) and 0.0 <= value < 2.0**32 else -1


Handler = Callable[[Request], Result]


def run(command: int, request: Request) -> Result:
    """Do it; UNSUPPORTED if it is not in the table."""
    handler = COMMANDS.get(command)
    return Result.UNSUPPORTED if handler is None else handler(request)


def set_mode(pilot: Autopilot, base_mode: int, custom_mode: int) -> Result:
    """DO_SET_MODE and the old SET_MODE: only custom modes."""
    if base_mode < 0 or not base_mode & CUSTOM_MODE:
        return Result.DENIED
    return _done(pilot.set_mode(custom_mode))


def _done(success: bool) -> Result:
    return Result.ACCEPTED if success else Result.FAILED


def _do_set_mode(request: Request) -> Result:
    return set_mode(request.pilot, request.number(1), request.number(2))


def _arm_disarm(request: Request) -> Result:
    what, magic = request.params[:2]
    if what == 1.0:
        return _done(request.pilot.arm(forced=magic == FORCE_ARM))
    if what == 0.0:
        return _done(request.pilot.disarm(forced=magic == FORCE_DISARM))
    return Result.UNSUPPORTED


def _takeoff(request: Request) -> Result:
    return _done(request.pilot.take_off(request.params[6], navigates=request.params[2] == 0.0))


def _land(request: Request) -> Result:
    return _done(request.pilot.set_mode(Mode.LAND))


def _return_to_launch(request: Request) -> Result:
    return _done(request.pilot.set_mode(Mode.RTL))


def _change_speed(request: Request) -> Result:
    return _done(request.pilot.guidance.steering.change_speed(request.number(1), request.params[1]))


def _get_home(request: Request) -> Result:
    message = BUILDERS[242](request.pilot)
    if message is None:
        return Result.FAILED
    request.replies.append(message)
    return Result.ACCEPTED


def _set_message_interval(request: Request) -> Result:
    message_id, period_us = request.number(1), request.params[1]
    if message_id not in BUILDERS:
        return _no_message(request, message_id, Result.DENIED)
    if not -1.0 <= period_us <= LONGEST_PERIOD_US:  # NaN compares false
        return Result.DENIED
    period_s = period_us * 1e-6 if period_us > 0.0 else None
    request.streams.set_period(message_id, period_s, request.pilot.now_s)
    return Result.ACCEPTED


def _get_message_interval(request: Request) -> Result:
    message_id = request.number(1)
    if not 0 <= message_id <= 65535:
        return Result.FAILED
    period_s = request.streams.period_s(message_id)
    period_us = 0 if message_id not in BUILDERS else -1 if period_s is None else round(period_s * 1e6)
    request.replies.append(dialect.MAVLink_message_interval_message(message_id, period_us))
    return Result.ACCEPTED


def _request_message(request: Request) -> Result:
    message_id = request.number(1)
    if message_id not in BUILDERS:
        return _no_message(request, message_id, Result.FAILED)
    message = BUILDERS[message_id](request.pilot)
    if message is not None:
        request.replies.append(message)
    return Result.ACCEPTED


def _no_message(request: Request, message_id: int, result: Result) -> Result:
    request.pilot.say(INFO, f"No ap_message for mavlink id ({message_id})")
    return result


def _fence_enable(request: Request) -> Result:
    switch = request.params[0]
    if switch not in (0.0, 1.0):
        return Result.FAILED
    return _done(request.pilot.parameters.store("FENCE_ENABLE", switch))


def _mission_start(request: Request) -> Result:
    return _done(request.pilot.start_mission())


def _set_mission_current(request: Request) -> Result:
    pilot, seq = request.pilot, request.number(1)
    if not 0 <= seq < len(pilot.mission.items):
        return Result.DENIED
    if request.params[1] == 1.0:
        pilot.mission.reset()
    if not pilot.mission.select(seq):
        return Result.FAILED
    request.replies.append(BUILDERS[MISSION_CURRENT_ID](pilot))
    return Result.ACCEPTED


COMMANDS: dict[int, Handler] = {
    20: _return_to_launch,  # NAV_RETURN_TO_LAUNCH
    21: _land,  # NAV_LAND
    22: _takeoff,  # NAV_TAKEOFF
    176: _do_set_mode,  # DO_SET_MODE
    178: _change_speed,  # DO_CHANGE_SPEED
    207: _fence_enable,  # DO_FENCE_ENABLE
    224: _set_mission_current,  # DO_SET_MISSION_CURRENT
    300: _mission_start,  # MISSION_START
    400: _arm_disarm,  # COMPONENT_ARM_DISARM
    410: _get_home,  # GET_HOME_POSITION
    510: _get_message_interval,  # GET_MESSAGE_INTERVAL
    511: _set_message_interval,  # SET_MESSAGE_INTERVAL
    512: _request_message,  # REQUEST_MESSAGE
}
