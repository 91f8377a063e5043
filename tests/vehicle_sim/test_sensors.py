"""Sensors without faults tell the truth; with them they err as asked, the same for everybody who looks."""

from __future__ import annotations

from math import atan2, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_sim.flight import Motion
from vehicle_sim.sensors import NONE, Faults, Sensors


def sensors(faults: Faults = NONE, *, yaw_rad: float = 0.0, height_m: float = 0.0, seed: int = 1) -> Sensors:
    motion = Motion(yaw_rad=yaw_rad)
    motion.down_m = -height_m
    made = Sensors(motion=motion, seed=seed, who=3)
    made.set_faults(faults, 0.0)
    return made


@given(now_s=st.floats(0.0, 1e5), yaw_rad=st.floats(-3.1, 3.1), height_m=st.floats(0.0, 100.0))
def test_without_faults_nothing_is_off(now_s: float, yaw_rad: float, height_m: float) -> None:
    fine = sensors(yaw_rad=yaw_rad, height_m=height_m)
    assert fine.gps_error_ned_m(now_s) == (0.0, 0.0, 0.0)
    assert fine.accel_error_ned_m_s2(now_s) == (0.0, 0.0, 0.0)
    assert (fine.baro_error_m(now_s), fine.gyro_yaw_error_rad_s(now_s), fine.has_fix) == (0.0, 0.0, True)
    assert fine.compass_error_rad(now_s) == pytest.approx(0.0, abs=1e-9)


@given(now_s=st.floats(0.0, 1e4), seed=st.integers(0, 2**32 - 1))
def test_noise_is_bounded_repeats_and_is_new_with_each_sample(now_s: float, seed: int) -> None:
    noisy = Faults(gps_noise_m=2.0, baro_noise_m=3.0, gyro_noise_rad_s=0.1)
    one, other = sensors(noisy, seed=seed), sensors(noisy, seed=seed)
    other.gps_error_ned_m(now_s / 2.0)  # somebody looked before
    assert one.gps_error_ned_m(now_s) == other.gps_error_ned_m(now_s)
    assert max(map(abs, one.gps_error_ned_m(now_s))) <= 2.0
    assert abs(one.baro_error_m(now_s)) <= 3.0
    assert abs(one.gyro_yaw_error_rad_s(now_s)) <= 0.1
    assert one.gps_error_ned_m(now_s) != one.gps_error_ned_m(now_s + 0.21)


def test_satellites_and_switch_decide_about_the_fix() -> None:
    assert [sensors(Faults(satellites=count)).has_fix for count in (0, 5, 6, 10)] == [False, False, True, True]
    assert not sensors(Faults(gps_lost=True)).has_fix


def test_a_drift_begins_when_it_is_asked_for_and_a_stuck_barometer_keeps_its_height() -> None:
    motion = Motion(yaw_rad=0.0)
    baro = Sensors(motion=motion, seed=1, who=1)
    baro.set_faults(Faults(baro_drift_m_s=0.5, baro_error_m=2.0), 100.0)
    assert (baro.baro_error_m(100.0), baro.baro_error_m(104.0)) == (2.0, 4.0)
    motion.down_m = -10.0
    baro.set_faults(Faults(baro_stuck=True), 110.0)
    motion.down_m = -25.0
    assert baro.baro_error_m(120.0) == -15.0


def test_the_airframe_turns_the_compass_with_it_and_the_ground_does_not() -> None:
    airframe = Faults(compass_offset_fr_mgauss=(0.0, 50.0))
    errors = [sensors(airframe, yaw_rad=yaw_rad).compass_error_rad(0.0) for yaw_rad in (0.0, pi / 2.0, pi)]
    assert errors == pytest.approx([-atan2(50.0, 215.0), 0.0, atan2(50.0, 215.0)])
    ground = Faults(anomaly_ne_mgauss=(0.0, 80.0), anomaly_height_m=5.0)
    errors = [abs(sensors(ground, height_m=height_m).compass_error_rad(0.0)) for height_m in (0.0, 5.0, 50.0)]
    assert errors[0] == pytest.approx(atan2(80.0, 215.0))
    assert errors[1] == pytest.approx(atan2(10.0, 215.0))  # an eighth
    assert errors[2] < 0.001
