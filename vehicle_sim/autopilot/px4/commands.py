"""The commands a PX4 takes (COMMAND_LONG and COMMAND_INT): a table of handlers that each answer with a MAV_RESULT.

Handlers are total, as those of an ArduCopter are. What cannot be done now is TEMPORARILY_REJECTED.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from math import isfinite
from typing import Any

from comms.frames import geo_from_enu, swap_enu_ned
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.px4.commander import Commander
from vehicle_sim.autopilot.px4.failures import FAILURES, Failure, Unit
from vehicle_sim.autopilot.px4.modes import AUTO, Mode, mode_of
from vehicle_sim.autopilot.px4.navigation.hold import Hold
from vehicle_sim.autopilot.px4.telemetry import BUILDERS
from vehicle_sim.autopilot.request import ABOVE_SEA, FRAMES, FURTHEST_M, Request
from vehicle_sim.autopilot.severity import CRITICAL, INFO
from vehicle_sim.autopilot.telemetry.fields import CUSTOM_MODE
from vehicle_sim.flight import wrap_pi

FORCE_DISARM = 21196.0
CHANGE_MODE = 1  # the one flag of DO_REPOSITION that PX4 knows, and wants
HOME_ID, VERSION_ID, MISSION_CURRENT_ID = 242, 148, 42
LONGEST_PERIOD_US = 2**31 - 1


class Result(IntEnum):
    """MAV_RESULT."""

    ACCEPTED = 0
    TEMPORARILY_REJECTED = 1
    DENIED = 2
    UNSUPPORTED = 3
    FAILED = 4


Handler = Callable[[Request[Commander]], Result]


def set_mode(pilot: Commander, base_mode: int, custom_mode: int) -> Result:
    """The old SET_MODE, whose custom_mode has main and sub mode in one."""
    return _change_mode(pilot, base_mode, custom_mode >> 16 & 0xFF, custom_mode >> 24 & 0xFF)


def _change_mode(pilot: Commander, base_mode: int, main: int, sub: int) -> Result:
    """Only custom modes."""
    if base_mode < 0 or not base_mode & CUSTOM_MODE:
        return Result.ACCEPTED  # PX4 changes nothing then, and says so
    if main == AUTO and mode_of(main, sub) not in Mode.__members__.values():
        pilot.say(CRITICAL, "Unsupported auto mode")
    return _done(pilot.set_mode(mode_of(main, sub)))


def _done(success: bool) -> Result:
    return Result.ACCEPTED if success else Result.TEMPORARILY_REJECTED


def _do_set_mode(request: Request[Commander]) -> Result:
    base, main, sub = (request.number(index) & 0xFF if request.number(index) >= 0 else -1 for index in (1, 2, 3))
    return _change_mode(request.pilot, base, main, max(0, sub))


def _choose(mode: Mode, text: str = "") -> Handler:
    """A command that is a mode."""

    def choose(request: Request[Commander]) -> Result:
        pilot = request.pilot
        if not pilot.set_mode(mode):
            pilot.reject(mode)
            return Result.TEMPORARILY_REJECTED
        if text:
            pilot.say(INFO, text)
        return Result.ACCEPTED

    return choose


def _arm_disarm(request: Request[Commander]) -> Result:
    """Arming cannot be forced from outside: PX4 looks at everything all the same."""
    what, magic = request.params[:2]
    if what == 1.0:
        return _done(request.pilot.arm())
    if what == 0.0:
        return _done(request.pilot.disarm(forced=magic == FORCE_DISARM))
    request.pilot.say(CRITICAL, f"Unsupported ARM_DISARM param: {what:.3f}")
    return Result.UNSUPPORTED


def _takeoff(request: Request[Commander]) -> Result:
    """Parameter 7 is above the sea; NaN: a little above here."""
    altitude_m = request.params[6]
    if not request.pilot.take_off(altitude_m if isfinite(altitude_m) else None):
        request.pilot.reject(Mode.TAKEOFF)
        return Result.TEMPORARILY_REJECTED
    return Result.ACCEPTED


def _reposition(request: Request[Commander]) -> Result:
    """HOLD, elsewhere: what is NaN stays as it is. It asks for the change of mode."""
    pilot, wanted = request.pilot, request.number(2)
    if wanted != CHANGE_MODE:
        return Result.UNSUPPORTED
    goal = _place(request)
    if goal is None:
        return Result.DENIED
    if not pilot.set_mode(Mode.HOLD):
        pilot.reject(Mode.HOLD)
        return Result.TEMPORARILY_REJECTED
    hold, yaw_rad = pilot.guidance.navigator, request.params[3]
    speed_m_s = request.params[0]
    if speed_m_s > 0.0:
        pilot.steering.change_speed(1, speed_m_s)
    if isinstance(hold, Hold):
        hold.go(pilot.steering.ned_from_item(goal), yaw_rad=wrap_pi(yaw_rad) if abs(yaw_rad) <= 10.0 else None)
    return Result.ACCEPTED


def _place(request: Request[Commander]) -> Item | None:
    """Parameters 5 to 7, of which NaN (and in integers the largest number) leaves open; None: no place on the globe."""
    x, y, z = request.params[4:7]
    scale = 1e7 if request.frame is None else 1.0
    frame = ABOVE_SEA if request.frame is None else request.frame
    left_open = not (isfinite(x) and isfinite(y)) or (request.frame is not None and abs(x) >= 2.0**31 - 1)
    x, y = (0.0, 0.0) if left_open else (x * scale, y * scale)
    z = z if isfinite(z) else 0.0
    if frame not in FRAMES or not (abs(x) <= 9e8 and abs(y) <= 1.8e9 and abs(z) <= FURTHEST_M):
        return None
    return Item(0, frame, x=round(x), y=round(y), z=z)


def _change_speed(request: Request[Commander]) -> Result:
    """PX4 says yes, whatever it does."""
    request.pilot.steering.change_speed(request.number(1), request.params[1])
    return Result.ACCEPTED


def _set_home(request: Request[Commander]) -> Result:
    """Parameter 1 is 1: here. Else a place above the sea."""
    pilot, item = request.pilot, request.item
    if not pilot.parameters["COM_HOME_EN"]:
        return Result.DENIED
    if request.params[0] > 0.5:
        return _done(pilot.set_home(None))
    if item is None or not (item.x or item.y):
        return Result.DENIED
    north_m, east_m, down_m = pilot.steering.ned_from_item(item, pilot.steering.home_ned_m)
    return _done(pilot.set_home(geo_from_enu(pilot.origin, swap_enu_ned((north_m, east_m, down_m)))))


def _terminate(request: Request[Commander]) -> Result:
    """DO_FLIGHTTERMINATION: motors off, wherever it is; only an armed vehicle has anything to end."""
    if not request.params[0] > 0.5 or not request.pilot.armed:
        return Result.DENIED
    request.pilot.stop_motors()
    return Result.ACCEPTED


def _mission_start(request: Request[Commander]) -> Result:
    pilot = request.pilot
    if not pilot.mission.items:
        pilot.say(CRITICAL, "Mission start denied! No valid mission")
        return Result.DENIED
    if not -1.0 <= request.params[0] < len(pilot.mission.items):  # NaN compares false
        return Result.DENIED
    if not pilot.start_mission():
        pilot.reject(Mode.MISSION)
        return Result.TEMPORARILY_REJECTED
    return Result.ACCEPTED


def _set_mission_current(request: Request[Commander]) -> Result:
    pilot, seq = request.pilot, request.number(1)
    if not 0 <= seq < len(pilot.mission.items):
        return Result.DENIED
    if request.params[1] == 1.0:
        pilot.mission.reset()
    pilot.mission.select(seq)
    request.replies.append(BUILDERS[MISSION_CURRENT_ID](pilot))
    return Result.ACCEPTED


def _reboot(request: Request[Commander]) -> Result:
    what = request.params[0]
    if what == 0.0:
        return Result.ACCEPTED
    return Result.ACCEPTED if what in (1.0, 3.0) and request.pilot.reboot() else Result.DENIED


def _store_parameters(request: Request[Commander]) -> Result:
    """PREFLIGHT_STORAGE: they are kept as long as the vehicle is, so there is nothing to do."""
    return _done(not request.pilot.armed)


def _check(request: Request[Commander]) -> Result:
    """RUN_PREARM_CHECKS: they run all the time."""
    return Result.ACCEPTED


def _inject_failure(request: Request[Commander]) -> Result:
    """Only with SYS_FAILURE_EN."""
    pilot, unit, kind = request.pilot, request.number(1), request.number(2)
    if not pilot.parameters["SYS_FAILURE_EN"]:
        return Result.DENIED
    if unit not in Unit.__members__.values() or kind not in Failure.__members__.values():
        return Result.UNSUPPORTED
    what = FAILURES.get((Unit(unit), Failure(kind)))
    if what is None:
        return Result.UNSUPPORTED
    pilot.parameters.suffer(*what)
    return Result.ACCEPTED


def _set_message_interval(request: Request[Commander]) -> Result:
    """Parameter 2: microseconds, below 0 never, 0 as at power-on."""
    message_id, period_us = request.number(1), request.params[1]
    if message_id not in BUILDERS or not -1.0 <= period_us <= LONGEST_PERIOD_US:  # NaN compares false
        return Result.FAILED
    usual_s = request.streams.unasked_s.get(message_id)
    period_s = period_us * 1e-6 if period_us > 0.0 else usual_s if period_us == 0.0 else None
    request.streams.set_period(message_id, period_s, request.pilot.now_s)
    return Result.ACCEPTED


def _get_message_interval(request: Request[Commander]) -> Result:
    return Result.ACCEPTED if request.tell_interval(BUILDERS) else Result.DENIED


def _request_message(request: Request[Commander]) -> Result:
    return _tell(request.number(1))(request)


def _tell(message_id: int) -> Handler:
    """A command that asks for one message."""

    def tell(request: Request[Commander]) -> Result:
        builder = BUILDERS.get(message_id)
        message: Any = None if builder is None else builder(request.pilot)
        if message is None:
            return Result.DENIED
        request.replies.append(message)
        return Result.ACCEPTED

    return tell


COMMANDS: dict[int, Handler] = {
    20: _choose(Mode.RTL, "Returning to launch"),  # NAV_RETURN_TO_LAUNCH
    21: _choose(Mode.LAND, "Landing at current position"),  # NAV_LAND
    22: _takeoff,  # NAV_TAKEOFF
    176: _do_set_mode,  # DO_SET_MODE
    178: _change_speed,  # DO_CHANGE_SPEED
    179: _set_home,  # DO_SET_HOME
    185: _terminate,  # DO_FLIGHTTERMINATION
    192: _reposition,  # DO_REPOSITION
    224: _set_mission_current,  # DO_SET_MISSION_CURRENT
    245: _store_parameters,  # PREFLIGHT_STORAGE
    246: _reboot,  # PREFLIGHT_REBOOT_SHUTDOWN
    300: _mission_start,  # MISSION_START
    400: _arm_disarm,  # COMPONENT_ARM_DISARM
    401: _check,  # RUN_PREARM_CHECKS
    410: _tell(HOME_ID),  # GET_HOME_POSITION
    420: _inject_failure,  # INJECT_FAILURE
    510: _get_message_interval,  # GET_MESSAGE_INTERVAL
    511: _set_message_interval,  # SET_MESSAGE_INTERVAL
    512: _request_message,  # REQUEST_MESSAGE
    520: _tell(VERSION_ID),  # REQUEST_AUTOPILOT_CAPABILITIES
}
