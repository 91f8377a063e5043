"""The commands it takes (COMMAND_LONG and COMMAND_INT): a table of handlers, each of which answers with a MAV_RESULT.

Handlers are total: any float, NaN and infinities too, gives a result and never a surprise. What a handler wants to say
or send goes out behind the acknowledgement.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum

from comms.frames import geo_from_enu, swap_enu_ned
from vehicle_sim.autopilot.ardupilot.copter import Copter
from vehicle_sim.autopilot.ardupilot.modes import Mode
from vehicle_sim.autopilot.ardupilot.streams import GROUPS
from vehicle_sim.autopilot.ardupilot.telemetry import BUILDERS
from vehicle_sim.autopilot.navigation.auto import yaw_of
from vehicle_sim.autopilot.request import Request
from vehicle_sim.autopilot.setpoints import Setpoint
from vehicle_sim.autopilot.severity import INFO
from vehicle_sim.autopilot.telemetry.fields import CUSTOM_MODE

FORCE_ARM, FORCE_DISARM = 2989.0, 21196.0
MISSION_CURRENT_ID, VERSION_ID = 42, 148
ABOVE_HOME = 3  # the only MAV_FRAME of a takeoff
CHANGE_MODE = 1  # a flag of DO_REPOSITION
LONGEST_PERIOD_US = 2**31 - 1
SHORTEST_US, LONGEST_US = 1_000.0, 60_000_000.0  # what becomes of shorter and of longer ones


class Result(IntEnum):
    """MAV_RESULT."""

    ACCEPTED = 0
    DENIED = 2
    UNSUPPORTED = 3
    FAILED = 4


Handler = Callable[[Request[Copter]], Result]


def set_mode(pilot: Copter, base_mode: int, custom_mode: int) -> Result:
    """DO_SET_MODE and the old SET_MODE: only custom modes."""
    if base_mode < 0 or not base_mode & CUSTOM_MODE:
        return Result.DENIED
    return _done(pilot.set_mode(custom_mode))


def _done(success: bool) -> Result:
    return Result.ACCEPTED if success else Result.FAILED


def _do_set_mode(request: Request[Copter]) -> Result:
    return set_mode(request.pilot, request.number(1), request.number(2))


def _arm_disarm(request: Request[Copter]) -> Result:
    what, magic = request.params[:2]
    if what == 1.0:
        return _done(request.pilot.arm(forced=magic == FORCE_ARM))
    if what == 0.0:
        return _done(request.pilot.disarm(forced=magic == FORCE_DISARM))
    return Result.UNSUPPORTED


def _takeoff(request: Request[Copter]) -> Result:
    """Parameter 7 is above home; parameter 3 is 0 where it has to hold its place."""
    if request.frame not in (None, ABOVE_HOME):
        return Result.DENIED
    return _done(request.pilot.take_off(request.params[6], navigates=request.params[2] == 0.0))


def _land(request: Request[Copter]) -> Result:
    return _done(request.pilot.set_mode(Mode.LAND))


def _return_to_launch(request: Request[Copter]) -> Result:
    return _done(request.pilot.set_mode(Mode.RTL))


def _change_speed(request: Request[Copter]) -> Result:
    return _done(request.pilot.guidance.steering.change_speed(request.number(1), request.params[1]))


def _get_home(request: Request[Copter]) -> Result:
    message = BUILDERS[242](request.pilot)
    if message is None:
        return Result.FAILED
    request.replies.append(message)
    return Result.ACCEPTED


def _set_message_interval(request: Request[Copter]) -> Result:
    """Parameter 2: microseconds; -1 never, 0 as usual."""
    message_id, period_us = request.number(1), request.params[1]
    if message_id not in BUILDERS:
        return _no_message(request, message_id, Result.DENIED)
    if not -1.0 <= period_us <= LONGEST_PERIOD_US:  # NaN compares false
        return Result.DENIED
    period_s = max(SHORTEST_US, min(LONGEST_US, period_us)) * 1e-6 if period_us > 0.0 else None
    if period_us == 0.0:
        if not request.streams.has_usual(message_id, GROUPS.values()):
            return Result.FAILED
        period_s = request.streams.usual_s(message_id, GROUPS.values())
    request.streams.set_period(message_id, period_s, request.pilot.now_s)
    return Result.ACCEPTED


def _get_message_interval(request: Request[Copter]) -> Result:
    return Result.ACCEPTED if request.tell_interval(BUILDERS) else Result.FAILED


def _request_message(request: Request[Copter]) -> Result:
    message_id = request.number(1)
    if message_id not in BUILDERS:
        return _no_message(request, message_id, Result.FAILED)
    message = BUILDERS[message_id](request.pilot)
    if message is not None:
        request.replies.append(message)
    return Result.ACCEPTED


def _no_message(request: Request[Copter], message_id: int, result: Result) -> Result:
    request.pilot.say(INFO, f"No ap_message for mavlink id ({message_id})")
    return result


def _reposition(request: Request[Copter]) -> Result:
    """Only as COMMAND_INT (recorded). Parameter 2, bit 1: change to GUIDED for it. It ends a takeoff."""
    pilot, item = request.pilot, request.item
    if request.frame is None:
        return Result.UNSUPPORTED
    if pilot.mode is not Mode.GUIDED and not (request.number(2) > 0 and request.number(2) & CHANGE_MODE):
        return Result.DENIED
    if item is None or not (item.x or item.y):
        return Result.DENIED
    goal_ned_m = pilot.guidance.steering.ned_from_item(item)
    if not pilot.fence.allows(pilot, goal_ned_m) or not pilot.set_mode(Mode.GUIDED):
        return Result.FAILED
    pilot.guidance.end_takeoff()
    return _done(pilot.follow(Setpoint(position_ned_m=goal_ned_m)))


def _condition_yaw(request: Request[Copter]) -> Result:
    degrees, relative = request.params[0], request.params[3]
    if not 0.0 <= degrees <= 360.0 or relative not in (0.0, 1.0):
        return Result.FAILED
    nose_rad = request.pilot.guidance.steering.airframe.yaw_rad
    request.pilot.guidance.turn(yaw_of(request.params, nose_rad=nose_rad))
    return Result.ACCEPTED


def _set_home(request: Request[Copter]) -> Result:
    """Parameter 1 is 1, or no place: here. It stays there."""
    item, pilot = request.item, request.pilot
    here = request.params[0] == 1.0
    if item is None and not here:
        return Result.FAILED
    place = None
    if item is not None and (item.x or item.y) and not here:
        north_m, east_m, down_m = pilot.steering.ned_from_item(item, pilot.steering.home_ned_m)
        place = geo_from_enu(pilot.origin, swap_enu_ned((north_m, east_m, down_m)))
    done = pilot.set_home(place)
    pilot.home_locked |= done
    return _done(done)


def _terminate(request: Request[Copter]) -> Result:
    """DO_FLIGHTTERMINATION: motors off, wherever it is."""
    return _done(request.params[0] > 0.5 and request.pilot.disarm(forced=True))


def _pause_or_continue(request: Request[Copter]) -> Result:
    what = request.params[0]
    if what not in (0.0, 1.0):
        return Result.DENIED
    paused = what == 0.0
    if request.pilot.guidance.pause(paused):
        return Result.ACCEPTED
    request.pilot.say(INFO, "Failed to pause" if paused else "Failed to resume")
    return Result.FAILED


def _reboot(request: Request[Copter]) -> Result:
    """Parameter 1: 1 reboots, 3 into the bootloader, which is no different here."""
    if request.params[0] not in (1.0, 3.0):
        return Result.UNSUPPORTED
    return _done(request.pilot.reboot())


def _tell_capabilities(request: Request[Copter]) -> Result:
    if request.params[0] != 1.0:
        return Result.DENIED
    request.replies.append(BUILDERS[VERSION_ID](request.pilot))
    return Result.ACCEPTED


def _fence_enable(request: Request[Copter]) -> Result:
    switch = request.params[0]
    if switch not in (0.0, 1.0):
        return Result.FAILED
    return _done(request.pilot.parameters.store("FENCE_ENABLE", switch))


def _mission_start(request: Request[Copter]) -> Result:
    return _done(request.pilot.start_mission())


def _set_mission_current(request: Request[Copter]) -> Result:
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
    115: _condition_yaw,  # CONDITION_YAW
    176: _do_set_mode,  # DO_SET_MODE
    178: _change_speed,  # DO_CHANGE_SPEED
    179: _set_home,  # DO_SET_HOME
    185: _terminate,  # DO_FLIGHTTERMINATION
    192: _reposition,  # DO_REPOSITION
    193: _pause_or_continue,  # DO_PAUSE_CONTINUE
    207: _fence_enable,  # DO_FENCE_ENABLE
    224: _set_mission_current,  # DO_SET_MISSION_CURRENT
    246: _reboot,  # PREFLIGHT_REBOOT_SHUTDOWN
    300: _mission_start,  # MISSION_START
    400: _arm_disarm,  # COMPONENT_ARM_DISARM
    410: _get_home,  # GET_HOME_POSITION
    510: _get_message_interval,  # GET_MESSAGE_INTERVAL
    511: _set_message_interval,  # SET_MESSAGE_INTERVAL
    512: _request_message,  # REQUEST_MESSAGE
    520: _tell_capabilities,  # REQUEST_AUTOPILOT_CAPABILITIES
}
