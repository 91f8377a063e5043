"""What is reported is what is true, in the wire's units."""

from __future__ import annotations

from math import asin, atan2, degrees, hypot

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import VELOCITY_YAW, flying, order, ready, velocity
from vehicle_sim.autopilot.ardupilot.telemetry import BUILDERS


def test_every_position_message_tells_the_truth() -> None:
    station = flying()
    station.stream(24, 30, 32, 33, 74, 85)
    for _ in range(60):
        station.tick(velocity(3.0, -2.0, -0.5, mask=VELOCITY_YAW, yaw=1.0))
    truth = station.vehicle.truth
    local, attitude = station.last("LOCAL_POSITION_NED"), station.last("ATTITUDE")
    assert (local.x, local.y, local.z) == pytest.approx(truth.position_ned_m, rel=1e-6)
    assert (local.vx, local.vy, local.vz) == pytest.approx(truth.velocity_ned_m_s, rel=1e-5)
    assert (attitude.roll, attitude.pitch, attitude.yaw) == pytest.approx(
        (truth.roll_rad, truth.pitch_rad, truth.yaw_rad), rel=1e-5
    )
    assert local.time_boot_ms == round(1000 * station.now_s)
    place = station.last("GLOBAL_POSITION_INT")
    assert (place.lat - 473977420) / 1e7 * 111319.49 == pytest.approx(truth.position_ned_m[0], abs=0.02)
    assert place.relative_alt == pytest.approx(-1000.0 * truth.position_ned_m[2], abs=1.0)
    assert place.alt - place.relative_alt == 488100
    assert place.hdg == pytest.approx(100.0 * degrees(truth.yaw_rad), abs=1.0)
    assert (place.vx, place.vy) == (300, -200)
    assert station.last("VFR_HUD").groundspeed == pytest.approx(hypot(3.0, 2.0), abs=0.02)
    assert station.last("VFR_HUD").climb == pytest.approx(0.5, abs=0.02)
    assert station.last("GPS_RAW_INT").vel == pytest.approx(100.0 * hypot(3.0, 2.0), abs=2.0)
    echo = station.last("POSITION_TARGET_LOCAL_NED")
    assert (echo.type_mask, echo.vx, echo.vy, echo.vz) == (3079, 3.0, -2.0, -0.5)  # the recorded mask


def test_the_battery_drains_as_recorded() -> None:
    station = flying()
    station.stream(1, 147)
    before = station.vehicle.autopilot.charge.consumed_mah
    station.tick(seconds=36.0)
    status, battery = station.last("SYS_STATUS"), station.last("BATTERY_STATUS")
    assert (status.voltage_battery, battery.voltages[0], battery.voltages[1]) == (12600, 12600, 65535)
    assert status.current_battery == battery.current_battery == pytest.approx(2800, abs=10)  # recorded: 2810
    assert station.vehicle.autopilot.charge.consumed_mah - before == pytest.approx(280.0, abs=2.0)  # 28 A, 0.01 h
    assert (
        status.battery_remaining
        == battery.battery_remaining
        == round(100.0 * (1.0 - battery.current_consumed / 5000.0))
    )


def test_armed_control_bits_are_the_recorded_ones() -> None:
    station = ready()
    station.stream(1)
    assert station.last("SYS_STATUS").onboard_control_sensors_enabled == 1382153263
    station.order(400, 1)
    assert station.last("SYS_STATUS").onboard_control_sensors_enabled == 1398930479


@pytest.mark.parametrize("message_id", sorted(BUILDERS))
def test_each_message_can_be_requested_and_is_that_message(message_id: int) -> None:
    station = flying()
    heard = station.tick(velocity(1.0), order(207, 1), order(512, message_id))  # a fence that is on has a status
    assert message_id in [message.get_msgId() for message in heard]


def test_the_quaternion_is_the_attitude() -> None:
    station = flying()
    station.stream(30, 31)
    for _ in range(30):
        station.tick(velocity(4.0, 3.0, mask=VELOCITY_YAW, yaw=2.0))
    q, attitude = station.last("ATTITUDE_QUATERNION"), station.last("ATTITUDE")
    assert q.q1**2 + q.q2**2 + q.q3**2 + q.q4**2 == pytest.approx(1.0)
    roll = atan2(2.0 * (q.q1 * q.q2 + q.q3 * q.q4), 1.0 - 2.0 * (q.q2**2 + q.q3**2))
    pitch = asin(2.0 * (q.q1 * q.q3 - q.q4 * q.q2))
    yaw = atan2(2.0 * (q.q1 * q.q4 + q.q2 * q.q3), 1.0 - 2.0 * (q.q3**2 + q.q4**2))
    assert (roll, pitch, yaw) == pytest.approx((attitude.roll, attitude.pitch, attitude.yaw), abs=1e-6)


def test_what_the_sensors_read_hovering_is_what_was_recorded() -> None:
    """flight2a, at 494 m: gravity, the earth's field, and a motor's 1587 us."""
    station = flying(altitude_m=6.0)
    station.tick(seconds=5.0)
    station.stream(27, 29, 36, 65, 116)
    station.tick(seconds=1.0)
    imu, same = station.last("RAW_IMU"), station.last("SCALED_IMU2")
    assert (imu.xacc, imu.yacc, imu.zacc) == (0, 0, pytest.approx(-1000, abs=2))
    assert (imu.xgyro, imu.ygyro, imu.zgyro) == (0, 0, 0)
    assert hypot(imu.xmag, imu.ymag, imu.zmag) == pytest.approx(hypot(245, 13, 414), rel=0.01)
    assert (same.xacc, same.zacc, same.zmag) == (imu.xacc, imu.zacc, imu.zmag)
    assert station.last("SCALED_PRESSURE").press_abs == pytest.approx(955.28, abs=0.5)
    assert station.last("SERVO_OUTPUT_RAW").servo1_raw == pytest.approx(1587, abs=3)
    sticks = station.last("RC_CHANNELS")
    assert (sticks.chan1_raw, sticks.chan2_raw, sticks.chan3_raw, sticks.chan4_raw) == (1500, 1500, 1000, 1500)


def test_wind_by_parameter_blows_and_is_reported() -> None:
    station = flying()
    station.stream(168, 74)
    for name, value in ((b"SIM_WIND_SPD", 6.0), (b"SIM_WIND_DIR", 90.0)):
        station.tick(dialect.MAVLink_param_set_message(3, 1, name, value, 9))
    station.tick(seconds=1.0)
    assert station.vehicle.truth.velocity_ned_m_s[1] < -0.3  # a gust from the east, before it leans against it
    station.tick(seconds=15.0)
    assert station.vehicle.truth.velocity_ned_m_s[1] == pytest.approx(0.0, abs=0.02)
    assert (station.last("WIND").direction, station.last("WIND").speed) == (pytest.approx(90.0), pytest.approx(6.0))
    assert station.last("VFR_HUD").airspeed == pytest.approx(6.0, abs=0.05)
    assert station.vehicle.truth.roll_rad == pytest.approx(0.26, abs=0.02)  # leaning right, into it


def test_streams_come_in_the_groups_of_arducopter_and_by_parameter() -> None:
    station = ready()

    def kinds(seconds: float = 2.0) -> set[str]:
        return {message.get_type() for message in station.tick(seconds=seconds)} - {"HEARTBEAT", "STATUSTEXT"}

    station.tick(dialect.MAVLink_request_data_stream_message(3, 1, 1, 4, 1))
    assert kinds() == {"RAW_IMU", "SCALED_IMU2", "SCALED_PRESSURE"}
    station.tick(dialect.MAVLink_request_data_stream_message(3, 1, 1, 4, 0))
    assert kinds() == set()
    station.tick(dialect.MAVLink_param_set_message(3, 1, b"SR0_EXTRA1", 5.0, 4))
    heard = [message.get_type() for message in station.tick(seconds=4.0)]
    assert heard.count("ATTITUDE") == heard.count("AHRS2") == pytest.approx(20, abs=1)
    station.tick(dialect.MAVLink_param_set_message(3, 1, b"SR0_EXTRA1", 0.0, 4))
    assert kinds() == set()
    station.tick(dialect.MAVLink_request_data_stream_message(3, 1, 0, 2, 1))
    assert kinds() >= {
        "SYS_STATUS", "POWER_STATUS", "MEMINFO", "GPS_RAW_INT", "SERVO_OUTPUT_RAW", "RC_CHANNELS", "RAW_IMU",
        "SCALED_IMU2", "SCALED_PRESSURE", "GLOBAL_POSITION_INT", "LOCAL_POSITION_NED", "ATTITUDE", "SIMSTATE", "AHRS2",
        "VFR_HUD", "AHRS", "WIND", "SYSTEM_TIME", "BATTERY_STATUS", "EKF_STATUS_REPORT", "VIBRATION",
    }  # fmt: skip
