"""What is reported is what is true, in the wire's units."""

from __future__ import annotations

from math import degrees, hypot

import pytest

from tests.vehicle_sim.autopilot.ground_station import VELOCITY_YAW, flying, order, ready, velocity
from vehicle_sim.autopilot.telemetry import BUILDERS


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
