"""What the sensors read, and what the estimators make of it: GPS, inertia, pressure, compass, EKF, wind."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, sin
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint
from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.telemetry.fields import boot_ms, i16, i32, place, place_of, u16, wire_place
from vehicle_sim.flight import GRAVITY_M_S2, wrap_pi

WRONG_FIX_DEG = (-0.49275, -0.08884)  # how far off the first fix was
NO_FIX, FEW_SATELLITES = 1, 3  # GPS_RAW_INT while SIM_GPS_DISABLE is set (recorded)
HDOP, VDOP = 121, 200  # times 100 (recorded)
POSITION_LOST_FLAGS = 37  # EKF_STATUS_REPORT: attitude, vertical velocity and position alone (recorded)
BOARD_CDEG, AIR_CDEG = 3062, 3155  # temperatures (recorded)
SEA_LEVEL_HPA, SCALE_M, EXPONENT = 1013.25, 44330.0, 5.255  # barometric formula of the standard atmosphere
MG_PER_M_S2 = 1000.0 / GRAVITY_M_S2


def gps_raw_int(pilot: Autopilot) -> Any:
    stage, sensors = pilot.boot.stage, pilot.sensors
    if not stage.gps_fix:
        return dialect.MAVLink_gps_raw_int_message(0, 0, 0, 0, 0, 65535, 65535, 0, 0, 0)
    frame = pilot.airframe
    north, east, down = sensors.gps_error_ned_m(pilot.now_s)
    where = place_of(pilot, (frame.north_m + north, frame.east_m + east, frame.down_m + down))
    if stage.gps_wrong:
        wrong = (where.latitude_deg + WRONG_FIX_DEG[0], where.longitude_deg + WRONG_FIX_DEG[1])
        where = GeoPoint(*wrong, where.altitude_m - 5.0)
    latitude, longitude, altitude_mm = wire_place(where)
    error_north, error_east = sensors.faults.gps_velocity_error_ne_m_s
    north_m_s, east_m_s = frame.north_m_s + error_north, frame.east_m_s + error_east
    speed = hypot(north_m_s, east_m_s)
    course_deg = degrees(atan2(east_m_s, north_m_s)) % 360.0 if speed > 0.1 else 0.0
    fix, satellites = stage.gps_fix, min(stage.satellites, sensors.faults.satellites)
    if not sensors.has_fix:
        fix, satellites = NO_FIX, min(satellites, FEW_SATELLITES)
    return dialect.MAVLink_gps_raw_int_message(
        boot_ms(pilot) * 1000, fix, latitude, longitude, altitude_mm, HDOP, VDOP, u16(100.0 * speed),
        round(100.0 * course_deg) % 36000, satellites, altitude_mm, 300, 300, 40, 0, 0,
    )  # fmt: skip


def ekf_status_report(pilot: Autopilot) -> Any:
    flags = pilot.boot.stage.ekf_flags
    if pilot.boot.stage.position and not pilot.estimate.has_position:
        flags = POSITION_LOST_FLAGS
    return dialect.MAVLink_ekf_status_report_message(flags, *pilot.estimate.variances, 0.0)


def scaled_imu2(pilot: Autopilot) -> Any:
    return dialect.MAVLink_scaled_imu2_message(boot_ms(pilot), *_inertia(pilot), BOARD_CDEG)


def scaled_imu(pilot: Autopilot) -> Any:
    return dialect.MAVLink_scaled_imu_message(boot_ms(pilot), *_inertia(pilot), BOARD_CDEG)


def raw_imu(pilot: Autopilot) -> Any:
    return dialect.MAVLink_raw_imu_message(boot_ms(pilot) * 1000, *_inertia(pilot), 0, BOARD_CDEG)


def _inertia(pilot: Autopilot) -> tuple[int, ...]:
    """Specific force (mG), turn rates (mrad/s) and field (mGauss); forward, right, down.

    A multirotor feels its thrust alone, along its own vertical; what is left forward and right are the sensor's errors.
    """
    frame, sensors = pilot.airframe, pilot.sensors
    north, east = frame.lean_ne_m_s2
    thrust = hypot(north, east, GRAVITY_M_S2 - frame.down_m_s2)
    error_north, error_east, error_down = sensors.accel_error_ned_m_s2(pilot.now_s)
    cosine, sine = cos(frame.yaw_rad), sin(frame.yaw_rad)
    force = (
        error_north * cosine + error_east * sine,
        error_east * cosine - error_north * sine,
        error_down - (0.0 if frame.tumbling and not frame.on_ground else thrust),
    )
    rates = (0.0, 0.0, frame.yaw_rate_rad_s + sensors.gyro_yaw_error_rad_s(pilot.now_s))
    return (
        *(i16(MG_PER_M_S2 * axis) for axis in force),
        *(i16(1000.0 * axis) for axis in rates),
        *(i16(axis) for axis in sensors.field_frd_mgauss(pilot.now_s)),
    )


def scaled_pressure(pilot: Autopilot) -> Any:
    height_m = pilot.origin.altitude_m - pilot.airframe.down_m + pilot.sensors.baro_error_m(pilot.now_s)
    left = max(0.0, 1.0 - height_m / SCALE_M)
    return dialect.MAVLink_scaled_pressure_message(boot_ms(pilot), SEA_LEVEL_HPA * left**EXPONENT, 0.0, AIR_CDEG)


def ahrs(pilot: Autopilot) -> Any:
    off_rad = wrap_pi(pilot.estimate.yaw_rad - pilot.airframe.yaw_rad)
    return dialect.MAVLink_ahrs_message(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, abs(off_rad))


def ahrs2(pilot: Autopilot) -> Any:
    roll, pitch = pilot.estimate.attitude_rad
    where = place(pilot)
    latitude, longitude, _ = wire_place(where)
    return dialect.MAVLink_ahrs2_message(roll, pitch, pilot.estimate.yaw_rad, where.altitude_m, latitude, longitude)


def simstate(pilot: Autopilot) -> Any:
    """The truth, for those who test against a simulator."""
    frame = pilot.airframe
    roll, pitch = frame.attitude_rad
    where = place_of(pilot, (frame.north_m, frame.east_m, frame.down_m))
    latitude, longitude, _ = wire_place(where)
    return dialect.MAVLink_simstate_message(
        roll, pitch, frame.yaw_rad, 0.0, 0.0, frame.down_m_s2 - GRAVITY_M_S2, 0.0, 0.0, frame.yaw_rate_rad_s,
        i32(latitude), i32(longitude),
    )  # fmt: skip


def wind(pilot: Autopilot) -> Any:
    north, east = pilot.body.wind.steady_ne_m_s
    return dialect.MAVLink_wind_message(degrees(atan2(-east, -north)), hypot(north, east), 0.0)


def vibration(pilot: Autopilot) -> Any:
    return dialect.MAVLink_vibration_message(boot_ms(pilot) * 1000, 0.003, 0.003, 0.006, 0, 0, 0)
