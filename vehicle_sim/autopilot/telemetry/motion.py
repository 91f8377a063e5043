"""Where the vehicle believes it is, how it moves and where it is going."""

from __future__ import annotations

from math import cos, hypot, nan, sin
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.telemetry.fields import boot_ms, heading_deg, i16, i32, place, throttle, wire_place

MASK_VELOCITY, MASK_POSITION = 0xC07, 0xDF8


def attitude(pilot: Autopilot) -> Any:
    belief = pilot.estimate
    roll, pitch = belief.attitude_rad
    return dialect.MAVLink_attitude_message(
        boot_ms(pilot), roll, pitch, belief.yaw_rad, 0.0, 0.0, belief.yaw_rate_rad_s
    )


def attitude_quaternion(pilot: Autopilot) -> Any:
    roll, pitch = (0.5 * angle for angle in pilot.estimate.attitude_rad)
    yaw = 0.5 * pilot.estimate.yaw_rad
    cr, sr, cp, sp, cy, sy = cos(roll), sin(roll), cos(pitch), sin(pitch), cos(yaw), sin(yaw)
    return dialect.MAVLink_attitude_quaternion_message(
        boot_ms(pilot), cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy, 0.0, 0.0, pilot.estimate.yaw_rate_rad_s,
    )  # fmt: skip


def local_position_ned(pilot: Autopilot) -> Any:
    if not pilot.boot.stage.position:
        return None
    belief = pilot.estimate
    return dialect.MAVLink_local_position_ned_message(
        boot_ms(pilot), belief.north_m, belief.east_m, belief.down_m,
        belief.north_m_s, belief.east_m_s, belief.down_m_s,
    )  # fmt: skip


def global_position_int(pilot: Autopilot) -> Any:
    belief = pilot.estimate
    latitude, longitude, altitude_mm = 0, 0, 0
    if pilot.boot.stage.gps_fix > 1:
        latitude, longitude, altitude_mm = wire_place(place(pilot))
    return dialect.MAVLink_global_position_int_message(
        boot_ms(pilot), latitude, longitude, altitude_mm, i32(1000.0 * pilot.guidance.steering.height_m),
        i16(100.0 * belief.north_m_s), i16(100.0 * belief.east_m_s), i16(100.0 * belief.down_m_s),
        round(100.0 * heading_deg(pilot)) % 36000,
    )  # fmt: skip


def vfr_hud(pilot: Autopilot) -> Any:
    belief = pilot.estimate
    ground_m_s = hypot(belief.north_m_s, belief.east_m_s)
    wind_north, wind_east = pilot.body.wind.steady_ne_m_s
    air_m_s = hypot(belief.north_m_s - wind_north, belief.east_m_s - wind_east)
    return dialect.MAVLink_vfr_hud_message(
        air_m_s, ground_m_s, int(heading_deg(pilot)) % 360, round(100.0 * throttle(pilot)),
        pilot.origin.altitude_m - belief.down_m, -belief.down_m_s,
    )  # fmt: skip


def home_position(pilot: Autopilot) -> Any:
    if not pilot.boot.stage.origin:
        return None
    return dialect.MAVLink_home_position_message(
        *wire_place(pilot.home), 0.0, 0.0, 0.0, [nan] * 4, 0.0, 0.0, 0.0, boot_ms(pilot) * 1000
    )


def gps_global_origin(pilot: Autopilot) -> Any:
    if not pilot.boot.stage.origin:
        return None
    return dialect.MAVLink_gps_global_origin_message(*wire_place(pilot.origin), boot_ms(pilot) * 1000)


def position_target_local_ned(pilot: Autopilot) -> Any:
    """The setpoint it flies, as ArduCopter echoes it: nothing outside GUIDED."""
    setpoint = pilot.guidance.setpoint
    position, velocity = setpoint.position_ned_m, setpoint.velocity_ned_m_s
    if position is None and velocity is None:
        return None
    return dialect.MAVLink_position_target_local_ned_message(
        boot_ms(pilot), 1, MASK_VELOCITY if position is None else MASK_POSITION, *(position or (0.0, 0.0, 0.0)),
        *((velocity if position is None else None) or (0.0, 0.0, 0.0)), 0.0, 0.0, 0.0, 0.0, 0.0,
    )  # fmt: skip
