"""Failsafes: when, what is said, what is flown; against recordings where there are some."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import GUIDED, LAND, RTL, GroundStation, flying, ready, velocity
from tests.vehicle_sim.autopilot.test_estimate import set_params

CRITICAL = 5  # HEARTBEAT.system_status


def said_after(station: GroundStation, since_s: float) -> list[tuple[float, int, str]]:
    return [
        (round(at_s - since_s, 1), text.severity, text.text)
        for at_s, text in station.all("STATUSTEXT")
        if at_s > since_s
    ]


def test_gps_lost_in_flight_as_recorded() -> None:
    """probe3: SIM_GPS_DISABLE in GUIDED; LAND after 8 s; GUIDED is possible again a second after the fix."""
    station = flying()
    station.stream(24, 193)
    lost_s = station.now_s
    set_params(station, SIM_GPS_DISABLE=1.0)
    station.tick(seconds=8.4)
    assert said_after(station, lost_s) == [
        (pytest.approx(7.9, abs=0.21), 2, "EKF3 lane switch 1"),
        (pytest.approx(7.9, abs=0.21), 4, "EKF primary changed:1"),
        (pytest.approx(8.0, abs=0.21), 2, "EKF variance"),
        (pytest.approx(8.0, abs=0.21), 2, "EKF Failsafe: changed to LAND Mode"),
    ]
    flags = [report.flags for at_s, report in station.all("EKF_STATUS_REPORT") if at_s > lost_s]
    assert list(dict.fromkeys(flags)) == [831, 37]
    assert (station.last("GPS_RAW_INT").fix_type, station.last("GPS_RAW_INT").satellites_visible) == (1, 3)
    assert (station.last("HEARTBEAT").custom_mode, station.last("HEARTBEAT").system_status) == (LAND, CRITICAL)
    assert station.order(176, 1, GUIDED) == 4
    assert station.texts()[-1] == "Mode change to GUIDED failed: requires position"
    back_s = station.now_s
    set_params(station, SIM_GPS_DISABLE=0.0)
    station.tick(seconds=0.3)
    assert station.last("EKF_STATUS_REPORT").flags == 831
    assert station.order(176, 1, GUIDED) == 4  # not yet
    station.tick(seconds=1.0)
    assert said_after(station, back_s)[-1] == (pytest.approx(1.0, abs=0.21), 2, "EKF Failsafe Cleared")
    assert station.order(176, 1, GUIDED) == 0
    station.order(400, 0, 21196)
    assert station.texts()[-2:] == ["Disarming motors", "EKF primary changed:0"]


def test_without_a_position_a_landing_drifts_with_the_wind() -> None:
    station = flying()
    set_params(station, SIM_GPS_DISABLE=1.0, SIM_WIND_SPD=5.0, SIM_WIND_DIR=180.0)
    station.tick(seconds=20.0)
    assert station.vehicle.mode_name == "LAND"
    assert station.vehicle.truth.position_ned_m[0] > 5.0  # blown north


def test_few_satellites_are_no_fix() -> None:
    station = flying()
    set_params(station, SIM_GPS_NUMSATS=4.0)
    station.tick(seconds=9.0)
    assert station.vehicle.mode_name == "LAND"


def test_the_ekf_failsafe_can_be_switched_off() -> None:
    station = flying()
    set_params(station, FS_EKF_THRESH=0.0, SIM_GPS_DISABLE=1.0)
    station.tick(seconds=12.0)
    assert station.vehicle.mode_name == "GUIDED"
    assert station.order(176, 1, GUIDED) == 0  # it is there already, position or not
    assert station.order(176, 1, RTL) == 4


@pytest.mark.parametrize(
    ("action", "mode"), [(0, "GUIDED"), (1, "LAND"), (2, "RTL"), (3, "SMART_RTL"), (4, "SMART_RTL"), (7, "BRAKE")]
)
def test_a_low_voltage_acts_after_its_timer(action: int, mode: str) -> None:
    station = flying()
    set_params(station, BATT_FS_LOW_ACT=action)
    low_s = station.now_s
    set_params(station, SIM_BATT_VOLTAGE=10.4)
    station.tick(seconds=9.0)
    assert station.vehicle.mode_name == "GUIDED"
    station.tick(seconds=1.5)
    assert station.vehicle.mode_name == mode
    at_s, severity, text = said_after(station, low_s)[0]
    assert (at_s, severity) == (pytest.approx(10.1, abs=0.21), 4)
    assert text.startswith("Battery 1 is low 10.40V used ")
    assert text.endswith(" mAh")
    assert station.texts()[-1] == "Battery Failsafe"
    assert station.last("HEARTBEAT").system_status == CRITICAL


def test_critical_follows_low_and_acts_only_if_it_is_not_less_urgent() -> None:
    levels = {"BATT_LOW_MAH": 4700.0, "BATT_CRT_MAH": 4600.0}
    worse, milder = flying(), flying()
    set_params(worse, BATT_FS_LOW_ACT=2, BATT_FS_CRT_ACT=1, **levels)
    set_params(milder, BATT_FS_LOW_ACT=1, BATT_FS_CRT_ACT=2, **levels)
    for station, last in ((worse, "LAND"), (milder, "LAND")):
        station.tick(seconds=60.0)
        texts = [text.split(" used")[0] for text in station.texts() if text.startswith("Battery 1")]
        assert texts == ["Battery 1 is low 12.60V", "Battery 1 is critical 12.60V"]
        assert station.vehicle.mode_name == last
    assert worse.texts().count("Battery Failsafe") == 2
    assert milder.texts().count("Battery Failsafe") == 1


def test_a_battery_that_ends_ends_the_flight() -> None:
    station = flying()
    station.stream(1)
    set_params(station, SIM_BATT_CAP_AH=0.2)
    station.tick(seconds=20.0)
    sagging = [status.voltage_battery for _, status in station.all("SYS_STATUS")]
    assert sagging[0] > sagging[-1] > 9000
    station.tick(seconds=10.0)
    assert station.vehicle.truth.on_ground
    assert any(text.startswith("SIM Hit ground at") for text in station.texts())


def test_terminate_stops_the_motors_where_it_is() -> None:
    station = flying()
    set_params(station, BATT_FS_CRT_ACT=5, BATT_CRT_MAH=4990.0)
    station.tick(seconds=1.0)
    assert not station.vehicle.truth.armed


def test_a_failsafe_on_the_ground_disarms() -> None:
    station = ready()
    set_params(station, DISARM_DELAY=0.0, FS_GCS_ENABLE=1.0)
    station.tick(dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
    station.order(400, 1)
    station.tick(seconds=6.0)
    assert station.texts()[-2:] == ["GCS Failsafe - Disarming", "Disarming motors"]


def test_a_landing_goes_on_if_asked() -> None:
    station = flying()
    station.order(176, 1, LAND)
    set_params(station, FS_OPTIONS=8.0, BATT_FS_LOW_ACT=2, BATT_LOW_MAH=4990.0)
    station.tick(seconds=1.0)
    assert station.texts()[-1] == "Battery Failsafe - Continuing Landing"
    assert station.vehicle.mode_name == "LAND"


def test_a_dead_motor_tumbles_it_down_and_the_crash_is_noticed() -> None:
    station = flying()
    set_params(station, SIM_ENGINE_MUL=0.0)
    station.tick(velocity(1.0), seconds=8.0)
    assert station.vehicle.truth.on_ground
    assert not station.vehicle.truth.armed
    hit, crash, disarmed = station.texts()[-3:]
    assert hit.startswith("SIM Hit ground at ")
    assert crash.startswith("Crash: Disarming: AngErr=")
    assert crash.endswith(">30, Accel=0.0<3.0")
    assert disarmed == "Disarming motors"
    times = {text.text: at_s for at_s, text in station.all("STATUSTEXT")}
    assert times[crash] - times[hit] == pytest.approx(2.0, abs=0.21)


@pytest.mark.parametrize(("motor", "share"), [(0.0, 0.7), (7.0, 0.0)])
def test_a_weak_motor_or_one_it_does_not_have_changes_nothing(motor: float, share: float) -> None:
    station = flying()
    set_params(station, SIM_ENGINE_FAIL=motor, SIM_ENGINE_MUL=share)
    station.tick(seconds=5.0)
    assert -station.vehicle.truth.position_ned_m[2] == pytest.approx(10.0, abs=0.1)
