"""What a sensible ground station does: short sessions, each a list of what it sends tick by tick.

They are written blind, without looking at the answers, so that an episode is a value that can be cut shorter.
"""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from random import Random
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.fuzz.hostile import HOME
from vehicle_sim.autopilot.ardupilot.commands import COMMANDS
from vehicle_sim.autopilot.ardupilot.modes import Mode
from vehicle_sim.autopilot.ardupilot.parameters import TABLE

SYSTEM = 3
Turns = list[list[Any]]  # a list of messages for each tick
ARM, TAKEOFF, SET_MODE, INTERVAL, REQUEST, START = 400, 22, 176, 511, 512, 300
GUIDED, AUTO = 4, 3
WAYPOINT, RTL, LAND, LOITER_TIME, SPEED = 16, 20, 21, 19, 178
FENCE_CORNER, RALLY_POINT = 5001, 5100
PLAIN = (0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 3.0, 10.0, 90.0, -1.0)
STREAMED = (1, 2, 24, 30, 32, 33, 74, 85, 147, 193, 245)


def order(command: int, *params: float) -> Any:
    return dialect.MAVLink_command_long_message(SYSTEM, 1, command, 0, *params, *[0.0] * (7 - len(params)))


def wait(rng: Random) -> Turns:
    return [[] for _ in range(rng.randint(5, 30))]


def take_off(rng: Random) -> Turns:
    height_m = rng.choice((3.0, 10.0, 40.0))
    return [[order(SET_MODE, 1, GUIDED)], [order(ARM, 1)], [order(TAKEOFF, 0, 0, 0, nan, 0, 0, height_m)], *[[]] * 25]


def velocities(rng: Random) -> Turns:
    north, east, down = (rng.uniform(-12.0, 12.0) for _ in range(3))
    mask, frame = rng.choice((0xDC7, 0x9C7, 0x5C7)), rng.choice((1, 7, 8, 9))
    setpoint = dialect.MAVLink_set_position_target_local_ned_message(
        0, SYSTEM, 1, frame, mask, 0, 0, 0, north, east, down / 4.0, 0, 0, 0, 1.0, 0.3
    )
    return [[setpoint]] * rng.randint(5, 25)


def go_to(rng: Random) -> Turns:
    place = (rng.uniform(-80.0, 80.0), rng.uniform(-80.0, 80.0), -rng.uniform(2.0, 30.0))
    setpoint = dialect.MAVLink_set_position_target_local_ned_message(
        0, SYSTEM, 1, 1, 0xDF8, *place, 0, 0, 0, 0, 0, 0, 0, 0
    )
    return [[setpoint], *[[]] * rng.randint(5, 40)]


def items(rng: Random, kind: int, commands: tuple[int, ...]) -> Turns:
    """An upload, without waiting to be asked."""
    turns: Turns = [[dialect.MAVLink_mission_count_message(SYSTEM, 1, len(commands), kind)]]
    for seq, command in enumerate(commands):
        place = [round((at + rng.uniform(-5e-4, 5e-4)) * 1e7) for at in (HOME.latitude_deg, HOME.longitude_deg)]
        params = (4.0, 0.0, 0.0, 0.0) if command == FENCE_CORNER else (1.0, 5.0, 0.0, 0.0)
        turns.append(
            [dialect.MAVLink_mission_item_int_message(SYSTEM, 1, seq, 3, command, 0, 1, *params, *place, 12.0, kind)]
        )
    return turns


def mission(rng: Random) -> Turns:
    commands = (WAYPOINT, TAKEOFF, WAYPOINT, SPEED, WAYPOINT, LOITER_TIME, rng.choice((RTL, LAND)))
    start = [[order(SET_MODE, 1, AUTO)], [order(START)]]
    return items(rng, 0, commands) + start + [[] for _ in range(rng.randint(10, 60))]


def fence(rng: Random) -> Turns:
    enable = [[_param("FENCE_ENABLE", 1.0)], [order(207, 1)]]
    return items(rng, 1, (FENCE_CORNER,) * 4) + enable + items(rng, 2, (RALLY_POINT,) * 2)


def downloads(rng: Random) -> Turns:
    kind = rng.choice((0, 1, 2))
    ask = [[dialect.MAVLink_mission_request_int_message(SYSTEM, 1, seq, kind)] for seq in range(4)]
    done = [[dialect.MAVLink_mission_ack_message(SYSTEM, 1, 0, kind)]]
    clear = [[dialect.MAVLink_mission_clear_all_message(SYSTEM, 1, kind)]] if rng.random() < 0.3 else []
    return [[dialect.MAVLink_mission_request_list_message(SYSTEM, 1, kind)], *ask, *done, *clear]


def parameters(rng: Random) -> Turns:
    """Read them all, and set some near their defaults; a fault of the simulator is a parameter, too."""
    rows = rng.sample(TABLE, 3)
    sets = [[_param(row.name, row.default * rng.choice((0.5, 1.0, 2.0)) + rng.choice((0.0, 1.0)))] for row in rows]
    return [[dialect.MAVLink_param_request_list_message(SYSTEM, 1)], *sets]


def _param(name: str, value: float) -> Any:
    return dialect.MAVLink_param_set_message(SYSTEM, 1, name.encode(), value, 9)


def orders(rng: Random) -> Turns:
    """Some of the commands it takes, with numbers that may mean something."""
    return [[order(rng.choice(list(COMMANDS)), *rng.choices(PLAIN, k=7))] for _ in range(8)]


def streams(rng: Random) -> Turns:
    return [[order(INTERVAL, number, rng.choice((-1.0, 0.0, 100_000.0, 1e6)))] for number in rng.sample(STREAMED, 4)]


def change_mode(rng: Random) -> Turns:
    return [[order(SET_MODE, 1, int(rng.choice(list(Mode))))], *[[]] * rng.randint(1, 40)]


def come_down(rng: Random) -> Turns:
    return [[order(rng.choice((RTL, LAND)))], *[[]] * rng.randint(20, 120)]


def lose_the_ground(rng: Random) -> Turns:
    beat = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    return [[_param("FS_GCS_ENABLE", rng.choice((1.0, 3.0, 4.0, 5.0, 7.0)))], *[[beat]] * 3, *[[]] * 60, [beat]]


SESSIONS: tuple[Callable[[Random], Turns], ...] = (
    wait, take_off, take_off, velocities, velocities, go_to, mission, mission, fence, downloads, parameters, streams,
    orders, change_mode, come_down, lose_the_ground,
)  # fmt: skip
