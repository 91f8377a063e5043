"""Setpoints for OFFBOARD: which axes count, in which frame. PX4's mask is per axis, and NaN leaves an axis out, too."""

from __future__ import annotations

from math import cos, isfinite, sin
from typing import Any, NamedTuple

from comms.frames import GeoPoint, Vec3, enu_from_geo, swap_enu_ned
from vehicle_sim.autopilot.setpoints import (
    FASTEST_M_S,
    FASTEST_TURN_RAD_S,
    FURTHEST_M,
    YAW_BIT,
    YAW_RATE_BIT,
)

LOCAL_NED, BODY_NED = 1, 8  # MAV_FRAME: the only local ones that PX4 takes
ABOVE_SEA_FRAMES, ABOVE_HOME_FRAMES = frozenset({0, 5}), frozenset({3, 6})
POSITION_BIT, VELOCITY_BIT, ACCELERATION_BIT = 0x001, 0x008, 0x040  # of the first axis; the next ones are above
LARGEST_M_S2 = 1e3

Axes = tuple[float | None, float | None, float | None]  # north, east, down; None: left open
OPEN: Axes = (None, None, None)


class Trajectory(NamedTuple):
    """What to fly in OFFBOARD, axis by axis; all in the vehicle's own north-east-down frame.

    Where an axis has a position, its velocity is what is fed forward.
    """

    position_ned_m: Axes = OPEN
    velocity_ned_m_s: Axes = OPEN
    acceleration_ned_m_s2: Axes = OPEN
    yaw_rad: float | None = None
    yaw_rate_rad_s: float | None = None

    @property
    def says_something(self) -> bool:
        """PX4 counts as a sign of life only what has a number in it."""
        return any(x is not None for x in (*self.position_ned_m, *self.velocity_ned_m_s, *self.acceleration_ned_m_s2))


def local_trajectory(message: Any, *, yaw_rad: float) -> Trajectory | None:
    """SET_POSITION_TARGET_LOCAL_NED, for a vehicle whose nose is at `yaw_rad`; None: a frame that PX4 does not take."""
    velocity = _used(message.type_mask, VELOCITY_BIT, (message.vx, message.vy, message.vz), FASTEST_M_S)
    acceleration = _used(message.type_mask, ACCELERATION_BIT, (message.afx, message.afy, message.afz), LARGEST_M_S2)
    if message.coordinate_frame == LOCAL_NED:
        position = _used(message.type_mask, POSITION_BIT, (message.x, message.y, message.z), FURTHEST_M)
        return Trajectory(position, velocity, acceleration, *_turn(message))
    if message.coordinate_frame == BODY_NED:  # a position from the nose is none
        return Trajectory(OPEN, _turned(velocity, yaw_rad), _turned(acceleration, yaw_rad), *_turn(message))
    return None


def global_trajectory(message: Any, *, origin: GeoPoint, home: GeoPoint) -> Trajectory | None:
    """SET_POSITION_TARGET_GLOBAL_INT; None: a frame that PX4 does not take."""
    above_home = message.coordinate_frame in ABOVE_HOME_FRAMES
    if not above_home and message.coordinate_frame not in ABOVE_SEA_FRAMES:
        return None
    position: Axes = OPEN
    if isfinite(message.alt):
        altitude_m = message.alt + (home.altitude_m if above_home else 0.0)
        place = GeoPoint(message.lat_int * 1e-7, message.lon_int * 1e-7, altitude_m)
        position = _used(message.type_mask, POSITION_BIT, swap_enu_ned(enu_from_geo(origin, place)), FURTHEST_M)
    velocity = _used(message.type_mask, VELOCITY_BIT, (message.vx, message.vy, message.vz), FASTEST_M_S)
    return Trajectory(position, velocity, OPEN, *_turn(message))


def _used(mask: int, first_bit: int, vector: Vec3, largest: float) -> Axes:
    """The axes that the mask does not leave out, and that are numbers (NaN compares false) of this world."""
    x, y, z = (
        value if not mask & (first_bit << axis) and abs(value) <= largest else None for axis, value in enumerate(vector)
    )
    return x, y, z


def _turn(message: Any) -> tuple[float | None, float | None]:
    yaw = None if message.type_mask & YAW_BIT or not isfinite(message.yaw) else message.yaw
    rate_used = not message.type_mask & YAW_RATE_BIT and abs(message.yaw_rate) <= FASTEST_TURN_RAD_S
    return yaw, message.yaw_rate if rate_used else None


def _turned(vector: Axes, yaw_rad: float) -> Axes:
    """From the nose to north and east; of a half plane that is left open nothing is used."""
    forward, right, down = vector
    if forward is None or right is None:
        return None, None, down
    cosine, sine = cos(yaw_rad), sin(yaw_rad)
    return forward * cosine - right * sine, forward * sine + right * cosine, down
