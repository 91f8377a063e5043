"""SET_POSITION_TARGET_*: which vectors count, in which frame, and what is too bad to fly.

ArduCopter's mask rule: a vector is ignored if ANY of its three bits is set. A bad mask, frame or number stops it.
"""

from __future__ import annotations

from enum import IntEnum
from math import asin, atan2, cos, isfinite, sin, sqrt
from typing import Any, NamedTuple

from comms.frames import GeoPoint, Vec3, enu_from_geo, swap_enu_ned

POSITION_BITS, VELOCITY_BITS = 0x007, 0x038
YAW_BIT, YAW_RATE_BIT = 0x400, 0x800
THRUST_BIT, ATTITUDE_BIT = 0x40, 0x80  # of SET_ATTITUDE_TARGET
FURTHEST_M = 1e6
FASTEST_M_S = 1e3
FASTEST_TURN_RAD_S = 100.0


class Frame(IntEnum):
    """MAV_FRAME of the local setpoints. The OFFSET and BODY frames start at the vehicle, BODY turns with its nose."""

    LOCAL_NED = 1
    LOCAL_OFFSET_NED = 7
    BODY_NED = 8
    BODY_OFFSET_NED = 9


BODY_FRAMES = (Frame.BODY_NED, Frame.BODY_OFFSET_NED)
# MAV_FRAME of the global setpoints -> whether its altitude is above sea level (else above home).
GLOBAL_FRAMES = {0: True, 5: True, 3: False, 6: False}


class Setpoint(NamedTuple):
    """What to fly in GUIDED; vectors in the vehicle's own north-east-down frame. All None: stop.

    Attributes:
        velocity_ned_m_s: with a position, the feed-forward (unused); alone, what to fly.
    """

    position_ned_m: Vec3 | None = None
    velocity_ned_m_s: Vec3 | None = None
    yaw_rad: float | None = None
    yaw_rate_rad_s: float | None = None


STOP = Setpoint()


class Attitude(NamedTuple):
    """How to lean in GUIDED, and how to climb: from -1 (as fast down as it may) to 1 (up)."""

    roll_rad: float
    pitch_rad: float
    yaw_rad: float
    climb: float


def attitude_target(message: Any, *, hover: float = 0.5) -> Attitude | None:
    """SET_ATTITUDE_TARGET, whose thrust climbs above `hover` and sinks below. None: no attitude, no thrust, a bad one.

    Body rates alone, which real autopilots fly too, are not flown here.
    """
    norm = sqrt(sum(part * part for part in message.q)) if all(abs(part) <= 2.0 for part in message.q) else 0.0
    if message.type_mask & (ATTITUDE_BIT | THRUST_BIT) or not 0.5 < norm < 2.0 or not 0.0 <= message.thrust <= 1.0:
        return None  # NaN compares false
    w, x, y, z = (part / norm for part in message.q)
    above = message.thrust - hover
    return Attitude(
        roll_rad=atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        pitch_rad=asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x)))),
        yaw_rad=atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
        climb=above / (1.0 - hover) if above > 0.0 else above / hover,
    )


def local_setpoint(message: Any, *, position_ned_m: Vec3, yaw_rad: float) -> Setpoint:
    """SET_POSITION_TARGET_LOCAL_NED as a setpoint, for a vehicle at `position_ned_m` with its nose at `yaw_rad`."""
    if message.coordinate_frame not in Frame.__members__.values():
        return STOP
    body = message.coordinate_frame in BODY_FRAMES
    vectors = _used_vectors(message, (message.x, message.y, message.z))
    if vectors is None:
        return STOP
    position, velocity = vectors
    if body:
        position = position and _turned(position, yaw_rad)
        velocity = velocity and _turned(velocity, yaw_rad)
    if position and message.coordinate_frame != Frame.LOCAL_NED:
        (north, east, down), (dn, de, dd) = position_ned_m, position
        position = (north + dn, east + de, down + dd)
    return _with_yaw(message, position, velocity, yaw_from_rad=yaw_rad if body else 0.0)


def global_setpoint(message: Any, *, origin: GeoPoint, home: GeoPoint) -> Setpoint:
    """SET_POSITION_TARGET_GLOBAL_INT as a setpoint, for a vehicle whose local frame starts at `origin`."""
    above_sea = GLOBAL_FRAMES.get(message.coordinate_frame)
    if above_sea is None or not isfinite(message.alt):
        return STOP
    altitude_m = message.alt if above_sea else home.altitude_m + message.alt
    place = GeoPoint(message.lat_int * 1e-7, message.lon_int * 1e-7, altitude_m)
    vectors = _used_vectors(message, swap_enu_ned(enu_from_geo(origin, place)))
    return STOP if vectors is None else _with_yaw(message, *vectors, yaw_from_rad=0.0)


def _used_vectors(message: Any, place_ned_m: Vec3) -> tuple[Vec3 | None, Vec3 | None] | None:
    """(position, velocity), each None if ignored; None when neither counts or a number is bad."""
    mask = message.type_mask
    position = None if mask & POSITION_BITS else place_ned_m
    velocity = None if mask & VELOCITY_BITS else (message.vx, message.vy, message.vz)
    if position is None and velocity is None:
        return None
    if position and not all(abs(x) <= FURTHEST_M for x in position):  # NaN compares false
        return None
    if velocity and not all(abs(x) <= FASTEST_M_S for x in velocity):
        return None
    return position, velocity


def _with_yaw(message: Any, position: Vec3 | None, velocity: Vec3 | None, *, yaw_from_rad: float) -> Setpoint:
    yaw = None if message.type_mask & YAW_BIT else message.yaw + yaw_from_rad
    yaw_rate = None if message.type_mask & YAW_RATE_BIT else message.yaw_rate
    if (yaw is not None and not isfinite(yaw)) or (yaw_rate is not None and not abs(yaw_rate) <= FASTEST_TURN_RAD_S):
        return STOP
    return Setpoint(position, velocity, yaw, yaw_rate)


def _turned(vector: Vec3, yaw_rad: float) -> Vec3:
    forward, right, down = vector
    cosine, sine = cos(yaw_rad), sin(yaw_rad)
    return (forward * cosine - right * sine, forward * sine + right * cosine, down)
