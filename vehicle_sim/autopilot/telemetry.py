"""What the autopilot reports: one builder per MAVLink message, and the table of them by message id.

A builder returns None when there is nothing to report yet. Every field is clamped to its wire type.
"""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, degrees, hypot, nan, pi
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint, geo_from_enu
from vehicle_sim.autopilot.arming import complaints
from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.modes import MODES, Mode

Builder = Callable[[Autopilot], Any]

# HEARTBEAT.base_mode
CUSTOM_MODE, STABILIZED, MANUAL_INPUT, GUIDED_ENABLED, SAFETY_ARMED = 1, 16, 64, 8, 128
STANDBY, ACTIVE, CRITICAL = 3, 4, 5
ON_GROUND, IN_AIR, TAKING_OFF, LANDING = 1, 2, 3, 4  # EXTENDED_SYS_STATE.landed_state

# SYS_STATUS sensors as recorded, and the bits that come and go.
PRESENT, ENABLED, HEALTHY = 0x5371FC0F, 0x52419C0F, 0x47519C0F
GPS, AHRS, CONTROLLERS, LOGGING, PREARM = 0x20, 0x200000, 0x6000, 0x1000000, 0x10000000

# PARAM_FLOAT, COMMAND_INT, both SET_POSITION_TARGETs, MAVLINK2: what this autopilot really has.
CAPABILITIES = 2 | 8 | 128 | 256 | 8192
VERSION_4_5_5 = 0x040505FF
MASK_VELOCITY, MASK_POSITION = 0xC07, 0xDF8
BOOTED_AT_UNIX_S = 1_767_225_600  # 2026-01-01: the mission clock has no date, GPS time must have one
WRONG_FIX_DEG = (-0.49275, -0.08884)  # how far off the first fix was


def heartbeat(pilot: Autopilot) -> Any:
    base = CUSTOM_MODE | STABILIZED | MANUAL_INPUT
    if MODES[pilot.mode].autonomous:
        base |= GUIDED_ENABLED
    if pilot.armed:
        base |= SAFETY_ARMED
    status = ACTIVE if pilot.flying or pilot.boot.stage.booting else STANDBY
    if pilot.failsafes.active:
        status = CRITICAL
    return dialect.MAVLink_heartbeat_message(2, 3, base, int(pilot.mode), status, 3)


def sys_status(pilot: Autopilot) -> Any:
    stage = pilot.boot.stage
    present, enabled, healthy = PRESENT, ENABLED, HEALTHY
    if stage.gps_fix:
        present, enabled, healthy = present | GPS, enabled | GPS, healthy | GPS
    if stage.origin:
        enabled, healthy = enabled | AHRS, healthy | AHRS
    if MODES[pilot.mode].needs_position:
        enabled, healthy = enabled | CONTROLLERS, healthy | CONTROLLERS
    if pilot.armed:
        enabled |= LOGGING
    if pilot.armed or not complaints(pilot):
        healthy |= PREARM
    charge = pilot.charge
    return dialect.MAVLink_sys_status_message(
        present, enabled, healthy, 0, _u16(charge.battery.voltage_v * 1000.0), _i16(charge.current_a * 100.0),
        round(100.0 * charge.remaining), 0, 0, 0, 0, 0, 0,
    )  # fmt: skip


def system_time(pilot: Autopilot) -> Any:
    fixed = pilot.boot.stage.gps_fix
    return dialect.MAVLink_system_time_message(
        round((BOOTED_AT_UNIX_S + pilot.now_s) * 1e6) if fixed else 0, boot_ms(pilot)
    )


def local_position_ned(pilot: Autopilot) -> Any:
    if not pilot.boot.stage.position:
        return None
    frame = pilot.airframe
    return dialect.MAVLink_local_position_ned_message(
        boot_ms(pilot), frame.north_m, frame.east_m, frame.down_m, frame.north_m_s, frame.east_m_s, frame.down_m_s
    )


def global_position_int(pilot: Autopilot) -> Any:
    frame = pilot.airframe
    latitude, longitude, altitude_mm = 0, 0, 0
    if pilot.boot.stage.gps_fix > 1:
        latitude, longitude, altitude_mm = _wire_place(place(pilot))
    return dialect.MAVLink_global_position_int_message(
        boot_ms(pilot), latitude, longitude, altitude_mm, _i32(1000.0 * pilot.guidance.steering.height_m),
        _i16(100.0 * frame.north_m_s),
        _i16(100.0 * frame.east_m_s), _i16(100.0 * frame.down_m_s), round(100.0 * heading_deg(pilot)) % 36000,
    )  # fmt: skip


def attitude(pilot: Autopilot) -> Any:
    frame = pilot.airframe
    roll, pitch = frame.attitude_rad
    return dialect.MAVLink_attitude_message(boot_ms(pilot), roll, pitch, frame.yaw_rad, 0.0, 0.0, frame.yaw_rate_rad_s)


def ekf_status_report(pilot: Autopilot) -> Any:
    return dialect.MAVLink_ekf_status_report_message(pilot.boot.stage.ekf_flags, 0.005, 0.005, 0.001, 0.008, 0.0)


def gps_raw_int(pilot: Autopilot) -> Any:
    stage, frame = pilot.boot.stage, pilot.airframe
    if not stage.gps_fix:
        return dialect.MAVLink_gps_raw_int_message(0, 0, 0, 0, 0, 65535, 65535, 0, 0, 0)
    where = place(pilot)
    if stage.gps_wrong:
        wrong = (where.latitude_deg + WRONG_FIX_DEG[0], where.longitude_deg + WRONG_FIX_DEG[1])
        where = GeoPoint(*wrong, where.altitude_m - 5.0)
    latitude, longitude, altitude_mm = _wire_place(where)
    speed = hypot(frame.north_m_s, frame.east_m_s)
    course_deg = degrees(atan2(frame.east_m_s, frame.north_m_s)) % 360.0 if speed > 0.1 else 0.0
    return dialect.MAVLink_gps_raw_int_message(
        boot_ms(pilot) * 1000, stage.gps_fix, latitude, longitude, altitude_mm, 121, 200, _u16(100.0 * speed),
        round(100.0 * course_deg) % 36000, stage.satellites, altitude_mm, 300, 300, 40, 0, 0,
    )  # fmt: skip


def battery_status(pilot: Autopilot) -> Any:
    charge = pilot.charge
    volts = charge.battery.voltage_v
    return dialect.MAVLink_battery_status_message(
        0, 0, 0, 32767, [_u16(volts * 1000.0)] + [65535] * 9, _i16(charge.current_a * 100.0),
        _i32(charge.consumed_mah), _i32(charge.consumed_mah * volts * 0.036), round(100.0 * charge.remaining), 0, 1,
    )  # fmt: skip


def extended_sys_state(pilot: Autopilot) -> Any:
    landed = IN_AIR
    if not pilot.flying:
        landed = ON_GROUND
    elif pilot.guidance.landing:
        landed = LANDING
    elif pilot.guidance.taking_off:
        landed = TAKING_OFF
    return dialect.MAVLink_extended_sys_state_message(3, landed)


def vfr_hud(pilot: Autopilot) -> Any:
    frame = pilot.airframe
    ground_m_s = hypot(frame.north_m_s, frame.east_m_s)
    wind_north, wind_east = pilot.wind.steady_ne_m_s
    air_m_s = hypot(frame.north_m_s - wind_north, frame.east_m_s - wind_east)
    throttle = 34.0 * pilot.charge.current_a / pilot.charge.battery.hover_current_a  # recorded: 34 % hovering
    return dialect.MAVLink_vfr_hud_message(
        air_m_s, ground_m_s, int(heading_deg(pilot)) % 360, _u16(min(100.0, throttle)),
        pilot.origin.altitude_m - frame.down_m, -frame.down_m_s,
    )  # fmt: skip


def home_position(pilot: Autopilot) -> Any:
    if not pilot.boot.stage.origin:
        return None
    return dialect.MAVLink_home_position_message(
        *_wire_place(pilot.home), 0.0, 0.0, 0.0, [nan] * 4, 0.0, 0.0, 0.0, boot_ms(pilot) * 1000
    )


def gps_global_origin(pilot: Autopilot) -> Any:
    if not pilot.boot.stage.origin:
        return None
    return dialect.MAVLink_gps_global_origin_message(*_wire_place(pilot.origin), boot_ms(pilot) * 1000)


def autopilot_version(pilot: Autopilot) -> Any:
    return dialect.MAVLink_autopilot_version_message(
        CAPABILITIES, VERSION_4_5_5, 0, 0, 0, list(b"142aece2"), [0] * 8, [0] * 8, 0, 0, pilot.system_id
    )


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


def mission_current(pilot: Autopilot) -> Any:
    """The item that is flown; `total` counts without home."""
    mission = pilot.mission
    flies = int(pilot.mode is Mode.AUTO)
    return dialect.MAVLink_mission_current_message(
        mission.current, max(0, len(mission.items) - 1), int(mission.state), flies
    )


BUILDERS: dict[int, Builder] = {
    0: heartbeat,
    1: sys_status,
    2: system_time,
    24: gps_raw_int,
    30: attitude,
    32: local_position_ned,
    33: global_position_int,
    49: gps_global_origin,
    74: vfr_hud,
    42: mission_current,
    85: position_target_local_ned,
    147: battery_status,
    148: autopilot_version,
    193: ekf_status_report,
    242: home_position,
    245: extended_sys_state,
}


def boot_ms(pilot: Autopilot) -> int:
    """Milliseconds since power-on; wraps after 49 days, as the wire type does."""
    return round((pilot.now_s - pilot.started_at_s) * 1000.0) & 0xFFFFFFFF


def place(pilot: Autopilot) -> GeoPoint:
    frame = pilot.airframe
    return geo_from_enu(pilot.origin, (frame.east_m, frame.north_m, -frame.down_m))


def heading_deg(pilot: Autopilot) -> float:
    """Where the nose points, 0 to 360 clockwise from north."""
    return (pilot.airframe.yaw_rad % (2.0 * pi)) * 180.0 / pi


def _wire_place(where: GeoPoint) -> tuple[int, int, int]:
    return _i32(where.latitude_deg * 1e7), _i32(where.longitude_deg * 1e7), _i32(where.altitude_m * 1000.0)


def _i16(value: float) -> int:
    return max(-32768, min(32767, round(value)))


def _u16(value: float) -> int:
    return max(0, min(65535, round(value)))


def _i32(value: float) -> int:
    return max(-(2**31), min(2**31 - 1, round(value)))
