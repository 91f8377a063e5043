"""Truth and estimate: equal to the last bit while the sensors are fine, and each fault shows where it should."""

from __future__ import annotations

from math import hypot

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import VELOCITY_YAW, GroundStation, flying, position, velocity
from vehicle_sim.vehicle import VehicleConfig, VehicleTruth

METERS_A_DEGREE = 111319.49


def set_params(station: GroundStation, **values: float) -> None:
    for name, value in values.items():
        station.tick(dialect.MAVLink_param_set_message(3, 1, name.encode(), value, 9))


def error_m(station: GroundStation) -> float:
    """Horizontal distance between where it is and where it says it is."""
    north, east, _ = station.vehicle.truth.position_ned_m
    estimate = station.vehicle.autopilot.estimate
    return hypot(estimate.north_m - north, estimate.east_m - east)


def route(station: GroundStation) -> list[VehicleTruth]:
    """A minute of turns."""
    trace = []
    for tick in range(600):
        station.tick(velocity(3.0 if tick % 200 < 100 else -2.0, 0.01 * tick, 0.0, mask=VELOCITY_YAW, yaw=0.01 * tick))
        trace.append(station.vehicle.truth)
    return trace


@pytest.mark.parametrize("kind", ["simulated", "ideal"])
def test_after_faults_that_are_over_it_is_the_truth_again_to_the_last_bit(kind: str) -> None:
    config = VehicleConfig(kind=kind)  # type: ignore[arg-type]
    station = flying(config)
    set_params(station, SIM_GPS_NOISE=1.0, SIM_BARO_RND=1.0, SIM_MAG_RND=20.0)
    route(station)
    assert not station.vehicle.autopilot.estimate.exact
    set_params(station, SIM_GPS_NOISE=0.0, SIM_BARO_RND=0.0, SIM_MAG_RND=0.0)
    station.tick(seconds=40.0)
    assert station.vehicle.autopilot.estimate.exact
    station.stream(32, 33)
    station.tick(seconds=1.0)
    local, truth = station.last("LOCAL_POSITION_NED"), station.vehicle.truth
    assert (local.x, local.y, local.z) == pytest.approx(truth.position_ned_m, rel=1e-6, abs=1e-6)


def test_the_same_noise_gives_the_same_flight_and_another_seed_another() -> None:
    def flown(seed: int) -> list[VehicleTruth]:
        station = flying(seed=seed)
        set_params(station, SIM_GPS_NOISE=1.0, SIM_BARO_RND=0.5)
        return route(station)

    assert flown(5) == flown(5)
    assert flown(5) != flown(6)


def test_noise_moves_the_estimate_and_the_vehicle_with_it_within_bounds() -> None:
    station = flying()
    set_params(station, SIM_GPS_NOISE=1.0)
    station.tick(position(0.0, 0.0, -10.0))
    errors, offsets = [], []
    for _ in range(600):
        station.tick()
        errors.append(error_m(station))
        offsets.append(hypot(*station.vehicle.truth.position_ned_m[:2]))
    assert 0.05 < max(errors) < 1.5
    assert 0.02 < max(offsets) < 3.0


def test_a_small_glitch_drags_it_along() -> None:
    station = flying()
    station.tick(position(0.0, 0.0, -10.0))
    set_params(station, SIM_GPS_GLITCH_X=2.0 / METERS_A_DEGREE)
    station.tick(seconds=20.0)
    assert station.vehicle.truth.position_ned_m[0] == pytest.approx(-2.0, abs=0.05)
    assert station.vehicle.autopilot.estimate.north_m == pytest.approx(0.0, abs=0.05)
    assert "GPS Glitch or Compass error" not in station.texts()


def test_a_large_glitch_is_rejected_said_and_believed_after_ten_seconds() -> None:
    station = flying()
    station.stream(24, 193)
    station.tick(position(0.0, 0.0, -10.0))
    set_params(station, SIM_GPS_GLITCH_X=30.0 / METERS_A_DEGREE)
    station.tick(seconds=5.0)
    assert station.texts()[-1] == "GPS Glitch or Compass error"
    assert (station.last("GPS_RAW_INT").lat - 473977420) / 1e7 * METERS_A_DEGREE == pytest.approx(30.0, abs=0.1)
    assert station.last("EKF_STATUS_REPORT").pos_horiz_variance > 1.0
    assert error_m(station) == 0.0
    station.tick(seconds=5.2)
    assert error_m(station) == pytest.approx(30.0, abs=0.1)
    station.tick(seconds=20.0)
    assert station.vehicle.truth.position_ned_m[0] == pytest.approx(-30.0, abs=0.2)
    assert station.texts()[-1] == "Glitch cleared"
    assert station.vehicle.mode_name == "GUIDED"  # a glitch alone is no failsafe


def test_without_gps_the_accelerometers_drift() -> None:
    still, drifting = flying(), flying()
    for station, bias in ((still, 0.0), (drifting, 0.1)):
        set_params(station, SIM_ACC1_BIAS_X=bias)
        station.tick(seconds=5.0)
        set_params(station, SIM_GPS_DISABLE=1.0)
        began_m = error_m(station)
        station.tick(seconds=6.0)
        assert error_m(station) - began_m == pytest.approx(0.5 * bias * 36.0, abs=0.15)


def test_the_barometer_decides_the_height_and_gps_does_not() -> None:
    station = flying()
    station.tick(position(0.0, 0.0, -10.0))
    set_params(station, SIM_GPS_GLITCH_Z=20.0)
    station.tick(seconds=5.0)
    assert station.vehicle.truth.position_ned_m[2] == pytest.approx(-10.0, abs=0.1)
    set_params(station, SIM_BARO_GLITCH=3.0)  # it believes to be higher
    station.tick(seconds=20.0)
    assert station.vehicle.truth.position_ned_m[2] == pytest.approx(-7.0, abs=0.1)


def test_a_turned_compass_turns_the_heading_but_gps_still_leads_it_home() -> None:
    station = flying()
    set_params(station, SIM_MAG1_OFS_Y=13.0 + 60.0)
    station.stream(30)
    station.tick(position(20.0, 0.0, -10.0), seconds=30.0)
    assert station.last("ATTITUDE").yaw == pytest.approx(-0.272, abs=0.02)  # atan(60 / 215)
    assert station.vehicle.truth.yaw_rad == pytest.approx(0.0, abs=0.01)
    assert station.vehicle.truth.position_ned_m == pytest.approx((20.0, 0.0, -10.0), abs=0.2)


def test_without_a_compass_the_gyro_lets_the_heading_drift() -> None:
    station = flying()
    set_params(station, SIM_MAG1_FAIL=1.0, SIM_GYR1_BIAS_Z=0.01)
    station.stream(1)
    station.tick(seconds=10.0)
    off_rad = station.vehicle.autopilot.estimate.yaw_rad - station.vehicle.truth.yaw_rad
    assert off_rad == pytest.approx(0.1, abs=0.02)
    assert not station.last("SYS_STATUS").onboard_control_sensors_health & 0x4
