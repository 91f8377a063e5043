"""Power-up as a recorded ArduCopter 4.5.5 SITL does it: order, texts, and what is not known yet."""

from __future__ import annotations

import pytest

from tests.vehicle_sim.autopilot.ground_station import GUIDED, HOME, GroundStation
from vehicle_sim.vehicle import VehicleConfig

BOOT_TEXTS = [
    "Calibrating barometer",
    "Barometer 1 calibration complete",
    "Barometer 2 calibration complete",
    "ArduPilot Ready",
    "AHRS: DCM active",
    "RC7: SaveWaypoint LOW",
    "EKF3 IMU0 initialised",
    "EKF3 IMU1 initialised",
    "AHRS: EKF3 active",
    "EKF3 IMU0 tilt alignment complete",
    "EKF3 IMU1 tilt alignment complete",
    "EKF3 IMU0 MAG0 initial yaw alignment complete",
    "EKF3 IMU1 MAG0 initial yaw alignment complete",
    "GPS 1: detected as u-blox at 230400 baud",
    "EKF3 IMU0 origin set",
    "Field Elevation Set: 488m",
    "EKF3 IMU1 origin set",
    "EKF3 IMU0 is using GPS",
    "EKF3 IMU1 is using GPS",
]
PREARM = 0x10000000


@pytest.mark.parametrize("boot_s", [0.0, 2.0, 41.2])
def test_the_same_texts_in_the_same_order_at_any_speed(boot_s: float) -> None:
    station = GroundStation(VehicleConfig(boot_s=boot_s))
    station.tick(seconds=boot_s + 0.6)
    assert [text for text in station.texts() if not text.startswith("PreArm")] == BOOT_TEXTS


def test_only_heartbeats_texts_and_home_flow_unasked() -> None:
    station = GroundStation()
    station.tick(seconds=10.0)
    assert {message.get_type() for _, message in station.log} == {
        "HEARTBEAT", "STATUSTEXT", "HOME_POSITION", "GPS_GLOBAL_ORIGIN",
    }  # fmt: skip
    beats = station.all("HEARTBEAT")
    assert [round(at_s, 1) for at_s, _ in beats] == [0.1, *[float(second) for second in range(1, 11)]]
    states = [(beat.base_mode, beat.custom_mode, beat.system_status) for _, beat in beats]
    assert states == [(81, 0, 4)] + [(81, 0, 3)] * 10


def test_position_and_health_come_with_gps_in_use() -> None:
    station = GroundStation(VehicleConfig(boot_s=41.2))
    station.order(176, 1, GUIDED)
    station.stream(1, 24, 32, 33, 193)
    station.tick(seconds=42.0)
    using_gps_s = next(at_s for at_s, text in station.all("STATUSTEXT") if text.text == "EKF3 IMU0 is using GPS")
    assert using_gps_s == pytest.approx(41.2, abs=0.11)
    assert station.all("LOCAL_POSITION_NED")[0][0] == using_gps_s
    armable = [at_s for at_s, status in station.all("SYS_STATUS") if status.onboard_control_sensors_health & PREARM]
    assert armable[0] == using_gps_s
    flags = [report.flags for _, report in station.all("EKF_STATUS_REPORT")]
    assert list(dict.fromkeys(flags)) == [1024, 0, 167, 831]
    fixes = [(fix.fix_type, fix.satellites_visible) for _, fix in station.all("GPS_RAW_INT")]
    assert list(dict.fromkeys(fixes)) == [(0, 0), (1, 3), (6, 10)]
    first_fix = next(fix for _, fix in station.all("GPS_RAW_INT") if fix.fix_type == 1)
    assert abs(first_fix.lat - HOME.latitude_deg * 1e7) > 1e6  # the first fix is wrong
    assert station.all("GLOBAL_POSITION_INT")[0][1].lat == 0
    assert station.last("GLOBAL_POSITION_INT").lat == 473977420
    assert (station.last("LOCAL_POSITION_NED").x, station.last("LOCAL_POSITION_NED").z) == (0.0, 0.0)
    assert station.last("SYS_STATUS").onboard_control_sensors_health == 1467087919  # recorded, GUIDED and ready
    assert station.last("SYS_STATUS").onboard_control_sensors_present == 1399979055


def test_why_it_does_not_arm_changes_as_recorded() -> None:
    station = GroundStation(VehicleConfig(boot_s=41.2))
    station.order(176, 1, GUIDED)
    reasons = {}
    for second in (6, 14, 21, 25):
        station.tick(seconds=second - station.now_s)
        assert station.order(400, 1) == 4
        said = [m for at_s, m in station.log if at_s == station.now_s and m.get_type() == "STATUSTEXT"]
        reasons[second] = [(m.severity, m.text) for m in said if m.text.startswith("Arm")]
    assert reasons == {
        6: [(2, "Arm: Accels inconsistent"), (2, "Arm: AHRS: waiting for home")],
        14: [(2, "Arm: Gyros inconsistent"), (2, "Arm: AHRS: waiting for home")],
        21: [(2, "Arm: Gyros inconsistent"), (2, "Arm: Need Position Estimate")],
        25: [(2, "Arm: Need Position Estimate")],
    }
    station.tick(seconds=30.2 - station.now_s)
    assert station.texts()[-1] == "PreArm: Need Position Estimate"


def test_home_and_origin_come_when_they_are_set_and_are_this_place() -> None:
    station = GroundStation()
    assert station.order(410) == 4  # no home yet
    assert station.order(512, 49) == 0  # accepted, and nothing sent
    assert not station.all("GPS_GLOBAL_ORIGIN")
    station.tick(seconds=3.0)
    home, origin = station.last("HOME_POSITION"), station.last("GPS_GLOBAL_ORIGIN")
    assert (home.latitude, home.longitude, home.altitude) == (473977420, 85455940, 488100)
    assert (origin.latitude, origin.longitude, origin.altitude) == (473977420, 85455940, 488100)
    assert station.order(410) == 0


def test_impossible_configs_are_refused() -> None:
    with pytest.raises(ValueError, match="simulated, ideal"):
        VehicleConfig(kind="real")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="boot_s"):
        VehicleConfig(boot_s=-1.0)
