"""What a sensible ground station does with a PX4, where that is not what it does with an ArduCopter."""

from __future__ import annotations

import struct
from collections.abc import Callable
from math import nan
from random import Random
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.fuzz.hostile import HOME
from tests.fuzz.sessions import (
    ARM,
    FENCE_CORNER,
    LAND,
    PLAIN,
    RALLY_POINT,
    RTL,
    SET_MODE,
    SPEED,
    START,
    SYSTEM,
    TAKEOFF,
    WAYPOINT,
    Turns,
    come_down,
    downloads,
    items,
    order,
    streams,
    wait,
)
from vehicle_sim.autopilot.parameters import REAL32
from vehicle_sim.autopilot.px4.commands import COMMANDS
from vehicle_sim.autopilot.px4.failures import FAILURES
from vehicle_sim.autopilot.px4.modes import Mode
from vehicle_sim.autopilot.px4.parameters import ROWS

REPOSITION, INJECT_FAILURE = 192, 420
BEAT = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)


def take_off(rng: Random) -> Turns:
    height_m = rng.choice((nan, HOME.altitude_m + 3.0, HOME.altitude_m + 10.0, HOME.altitude_m + 40.0))
    return [[order(ARM, 1)], [order(TAKEOFF, 0, 0, 0, nan, nan, nan, height_m)], *[[]] * 60]


def mode(number: Mode) -> Any:
    return order(SET_MODE, 1, number >> 16 & 0xFF, number >> 24)


def offboard(rng: Random) -> Turns:
    """Setpoints, the mode, more setpoints, and then perhaps none."""
    north, east, down = (rng.uniform(-12.0, 12.0) for _ in range(3))
    mask, frame = rng.choice((0xDC7, 0x9C7, 0x5C7, 0xDC3, 0xFC7)), rng.choice((1, 8))
    setpoint = dialect.MAVLink_set_position_target_local_ned_message(
        0, SYSTEM, 1, frame, mask, nan, nan, -5.0, north, east, down / 4.0, 0.5, 0.5, 0, 1.0, 0.3
    )
    attitude = dialect.MAVLink_set_attitude_target_message(0, SYSTEM, 1, 7, [0.99, 0.1, 0.05, 0.0], 0, 0, 0, 0.55)
    flown = rng.choice((setpoint, setpoint, attitude))
    lost = [[] for _ in range(rng.choice((0, 0, 30)))]
    return [[flown]] * 3 + [[mode(Mode.OFFBOARD), flown]] + [[flown]] * rng.randint(5, 30) + lost


def reposition(rng: Random) -> Turns:
    place = [at + rng.uniform(-8e-4, 8e-4) for at in (HOME.latitude_deg, HOME.longitude_deg)]
    return [[order(REPOSITION, -1, 1, 0, nan, *place, HOME.altitude_m + rng.uniform(2.0, 40.0))], *[[]] * 30]


def mission(rng: Random) -> Turns:
    commands = (*((TAKEOFF,) if rng.random() < 0.5 else ()), WAYPOINT, SPEED, WAYPOINT, rng.choice((RTL, LAND)))
    return items(rng, 0, commands) + [[order(START)]] + [[] for _ in range(rng.randint(10, 80))]


def fence(rng: Random) -> Turns:
    limits = [[_param("GF_MAX_HOR_DIST", rng.choice((0.0, 20.0)))], [_param("GF_ACTION", rng.randint(0, 5))]]
    return items(rng, 1, (FENCE_CORNER,) * 4) + limits + items(rng, 2, (RALLY_POINT,) * 2)


def parameters(rng: Random) -> Turns:
    rows = rng.sample(ROWS, 3)
    sets = [[_param(row.name, row.default * rng.choice((0.5, 1.0, 2.0)) + rng.choice((0.0, 1.0)))] for row in rows]
    return [[dialect.MAVLink_param_request_list_message(SYSTEM, 1)], *sets]


def _param(name: str, value: float) -> Any:
    """Bytewise, as its type wants it."""
    kind = next(row.type for row in ROWS if row.name == name)
    if kind != REAL32:
        value = struct.unpack("<f", struct.pack("<i", int(value)))[0]
    return dialect.MAVLink_param_set_message(SYSTEM, 1, name.encode(), value, kind)


def failure(rng: Random) -> Turns:
    unit, kind = rng.choice(list(FAILURES))
    return [[_param("SYS_FAILURE_EN", 1)], [order(INJECT_FAILURE, unit, kind)], *[[]] * rng.randint(5, 120)]


def sticks(rng: Random) -> Turns:
    held = [rng.randint(-1000, 1000) for _ in range(2)]
    hands = dialect.MAVLink_manual_control_message(SYSTEM, *held, rng.choice((0, 500, 900)), 0, 0)
    wanted = rng.choice((Mode.POSCTL, Mode.ALTCTL, Mode.STABILIZED, Mode.ACRO))
    return [[hands], [hands, mode(wanted)], *[[hands]] * rng.randint(5, 40), *[[]] * rng.choice((0, 20))]


def orders(rng: Random) -> Turns:
    return [[order(rng.choice(list(COMMANDS)), *rng.choices(PLAIN, k=7))] for _ in range(8)]


def change_mode(rng: Random) -> Turns:
    return [[mode(rng.choice(list(Mode)))], *[[]] * rng.randint(1, 40)]


def lose_the_ground(rng: Random) -> Turns:
    return [[_param("NAV_DLL_ACT", rng.choice((1, 2, 3, 5, 6)))], *[[BEAT]] * 3, *[[]] * 170, [BEAT]]


SESSIONS: tuple[Callable[[Random], Turns], ...] = (
    wait, take_off, take_off, offboard, offboard, offboard, reposition, mission, mission, fence, downloads, parameters,
    streams, orders, change_mode, come_down, sticks, failure, lose_the_ground,
)  # fmt: skip
