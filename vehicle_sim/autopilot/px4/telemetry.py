"""What a PX4 reports in its own way, and the table of all it can report."""

from __future__ import annotations

from math import nan
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.px4.checks import complaints
from vehicle_sim.autopilot.px4.commander import Commander
from vehicle_sim.autopilot.px4.modes import MODES, Mode
from vehicle_sim.autopilot.telemetry import SHARED, Builder, motion, sensed
from vehicle_sim.autopilot.telemetry.fields import (
    AUTO_ENABLED,
    CUSTOM_MODE,
    GUIDED_ENABLED,
    MANUAL_INPUT,
    SAFETY_ARMED,
    STABILIZED,
    boot_ms,
    heading_deg,
    i16,
    i32,
    place_of,
    throttle,
    u16,
    wire_place,
)

QUADROTOR, PX4_AUTOPILOT, MAVLINK_2 = 2, 12, 3
UNINIT, STANDBY, ACTIVE, CRITICAL = 0, 3, 4, 5  # MAV_STATE

# SYS_STATUS: gyro, accelerometer, compass, barometer, motors, attitude; and the bits that come and go.
SENSORS = 0x1 | 0x2 | 0x4 | 0x8 | 0x8000 | 0x200000
COMPASS, GPS, STICKS, GEOFENCE, BATTERY, PREARM = 0x4, 0x20, 0x10000, 0x100000, 0x2000000, 0x10000000

# What this vehicle really has, of the bits that PX4 sets.
MISSION_FLOAT, MISSION_INT, COMMAND_INT, PARAMS_BYTEWISE = 1, 4, 8, 16
SET_ATTITUDE, SET_LOCAL, SET_GLOBAL, TERMINATION, MAVLINK2, FENCES, RALLIES = 64, 128, 256, 2048, 8192, 16384, 32768
CAPABILITIES = (
    MISSION_FLOAT | MISSION_INT | COMMAND_INT | PARAMS_BYTEWISE | SET_ATTITUDE | SET_LOCAL | SET_GLOBAL | TERMINATION
    | MAVLINK2 | FENCES | RALLIES
)  # fmt: skip
VERSION_1_15_4 = 0x010F04FF
UNMEASURED_C = 32767


def heartbeat(pilot: Commander) -> Any:
    row = MODES[pilot.mode]
    base = CUSTOM_MODE
    base |= MANUAL_INPUT if row.manual else 0
    base |= STABILIZED if row.level else 0
    base |= AUTO_ENABLED | GUIDED_ENABLED if row.auto else 0
    base |= SAFETY_ARMED if pilot.armed else 0
    status = UNINIT if pilot.boot.stage.booting else STANDBY
    if pilot.armed:
        status = CRITICAL if pilot.failsafes.active else ACTIVE
    return dialect.MAVLink_heartbeat_message(QUADROTOR, PX4_AUTOPILOT, base, int(pilot.mode), status, MAVLINK_2)


def sys_status(pilot: Commander) -> Any:
    present = healthy = SENSORS | BATTERY
    if pilot.boot.stage.gps_fix:
        present |= GPS
        healthy |= GPS if pilot.has_position else 0
    if pilot.has_sticks:
        present, healthy = present | STICKS, healthy | STICKS
    if pilot.sensors.faults.compass_dead:
        healthy &= ~COMPASS
    present |= GEOFENCE | PREARM
    healthy |= 0 if pilot.geofence.breached else GEOFENCE
    healthy |= PREARM if pilot.armed or not complaints(pilot, pilot.intended) else 0
    charge = pilot.charge
    return dialect.MAVLink_sys_status_message(
        present, present, healthy, 0, u16(charge.voltage_v * 1000.0), i16(charge.current_a * 100.0),
        round(100.0 * pilot.charge_share), 0, 0, 0, 0, 0, 0,
    )  # fmt: skip


def battery_status(pilot: Commander) -> Any:
    charge = pilot.charge
    return dialect.MAVLink_battery_status_message(
        0, 0, 0, UNMEASURED_C, [u16(charge.voltage_v * 1000.0)] + [65535] * 9, i16(charge.current_a * 100.0),
        i32(charge.consumed_mah), -1, round(100.0 * pilot.charge_share), 0, 1 + int(pilot.battery),
    )  # fmt: skip


def autopilot_version(pilot: Commander) -> Any:
    return dialect.MAVLink_autopilot_version_message(
        CAPABILITIES, VERSION_1_15_4, 0, 0, 0, [0] * 8, [0] * 8, [0] * 8, 0, 0, pilot.system_id
    )


def mission_current(pilot: Commander) -> Any:
    mission = pilot.mission
    flies = 1 if pilot.mode is Mode.MISSION else 2
    return dialect.MAVLink_mission_current_message(
        max(0, mission.current), len(mission.items), int(mission.state), flies
    )


def position_target_global_int(pilot: Commander) -> Any:
    local = motion.position_target_local_ned(pilot)
    if local is None or pilot.setpoint_ned_m is None:
        return None
    latitude, longitude, _ = wire_place(place_of(pilot, pilot.setpoint_ned_m))
    altitude_m = pilot.origin.altitude_m - pilot.setpoint_ned_m[2]
    return dialect.MAVLink_position_target_global_int_message(
        boot_ms(pilot), 5, local.type_mask, latitude, longitude, altitude_m, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    )


def attitude_target(pilot: Commander) -> Any:
    """The attitude it has, which is the one it asks for in an airframe that follows at once."""
    if not pilot.armed:
        return None
    now = motion.attitude_quaternion(pilot)
    attitude = [now.q1, now.q2, now.q3, now.q4]
    thrust = throttle(pilot)
    return dialect.MAVLink_attitude_target_message(boot_ms(pilot), 0, attitude, 0.0, 0.0, now.yawspeed, thrust)


def altitude(pilot: Commander) -> Any:
    if not pilot.boot.stage.origin:
        return None
    up_m = -pilot.estimate.down_m
    amsl_m, above_home_m = pilot.origin.altitude_m + up_m, pilot.steering.height_m
    return dialect.MAVLink_altitude_message(boot_ms(pilot) * 1000, amsl_m, amsl_m, up_m, above_home_m, nan, nan)


def nav_controller_output(pilot: Commander) -> Any:
    goal = pilot.setpoint_ned_m
    if goal is None:
        return None
    heading = i16(heading_deg(pilot))
    away_m, up_m = pilot.steering.distance_m(goal), pilot.estimate.down_m - goal[2]
    return dialect.MAVLink_nav_controller_output_message(0.0, 0.0, heading, heading, u16(away_m), up_m, 0.0, 0.0)


def estimator_status(pilot: Commander) -> Any:
    flags = pilot.boot.stage.ekf_flags
    if pilot.boot.stage.position and not pilot.estimate.has_position:
        flags &= 0x25  # attitude, height and its change alone
    velocity, position, height, compass = pilot.estimate.variances
    return dialect.MAVLink_estimator_status_message(
        boot_ms(pilot) * 1000, flags, velocity, position, height, compass, 0.0, 0.0, 0.5, 0.8
    )


def wind_cov(pilot: Commander) -> Any:
    north, east = pilot.body.wind.steady_ne_m_s
    return dialect.MAVLink_wind_cov_message(boot_ms(pilot) * 1000, north, east, 0.0, 0.0, 0.0, nan, nan, nan)


def highres_imu(pilot: Commander) -> Any:
    """Specific force, turn rate, field, pressure: in m/s2, rad/s, gauss and hPa."""
    raw, air = sensed.raw_imu(pilot), sensed.scaled_pressure(pilot)
    force = (raw.xacc / sensed.MG_PER_M_S2, raw.yacc / sensed.MG_PER_M_S2, raw.zacc / sensed.MG_PER_M_S2)
    rates = (raw.xgyro / 1000.0, raw.ygyro / 1000.0, raw.zgyro / 1000.0)
    field = (raw.xmag / 1000.0, raw.ymag / 1000.0, raw.zmag / 1000.0)
    return dialect.MAVLink_highres_imu_message(
        boot_ms(pilot) * 1000, *force, *rates, *field, air.press_abs, 0.0, pilot.origin.altitude_m, 31.55, 0x1FFF
    )


# Of what any autopilot here can report, what a PX4 does.
KEPT = (2, 24, 29, 30, 31, 32, 33, 36, 49, 65, 74, 85, 116, 241, 242, 245)

BUILDERS: dict[int, Builder] = {number: SHARED[number] for number in KEPT} | {
    0: heartbeat,
    1: sys_status,
    42: mission_current,
    62: nav_controller_output,
    83: attitude_target,
    87: position_target_global_int,
    105: highres_imu,
    141: altitude,
    147: battery_status,
    148: autopilot_version,
    230: estimator_status,
    231: wind_cov,
}
