"""Modes, arming, takeoff, hold, return and landing of a PX4."""

from __future__ import annotations

from math import cos, hypot, nan, radians

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import HOME, SYSTEM
from tests.vehicle_sim.autopilot.px4.station import (
    ACCEPTED,
    DENIED,
    REJECTED,
    UNSUPPORTED,
    Px4Station,
    flying,
    ready,
)
from vehicle_sim.autopilot.px4.modes import MODES, Mode
from vehicle_sim.vehicle import VehicleConfig

DEGREE_M = 111_319.49

# px4_custom_mode.h: main mode in the third byte, sub mode in the fourth.
NUMBERS = {
    Mode.MANUAL: 0x00010000, Mode.ALTCTL: 0x00020000, Mode.POSCTL: 0x00030000, Mode.TAKEOFF: 0x02040000,
    Mode.HOLD: 0x03040000, Mode.MISSION: 0x04040000, Mode.RTL: 0x05040000, Mode.LAND: 0x06040000,
    Mode.ACRO: 0x00050000, Mode.OFFBOARD: 0x00060000, Mode.STABILIZED: 0x00070000,
}  # fmt: skip
# HEARTBEAT.base_mode on the ground: custom, stabilized, and manual input or auto and guided.
BASES = dict.fromkeys(Mode, 1 | 16 | 64) | {
    Mode.TAKEOFF: 29, Mode.HOLD: 29, Mode.MISSION: 29, Mode.RTL: 29, Mode.LAND: 29, Mode.ACRO: 65, Mode.OFFBOARD: 17,
}  # fmt: skip


@pytest.mark.parametrize("mode", Mode)
def test_on_the_ground_every_mode_can_be_chosen_and_is_told(mode: Mode) -> None:
    station = ready()
    assert station.choose(mode) == ACCEPTED
    station.tick(seconds=1.0)
    beat = station.last("HEARTBEAT")
    assert (beat.autopilot, beat.type, beat.custom_mode, beat.base_mode) == (12, 2, NUMBERS[mode], BASES[mode])


def test_set_mode_is_answered_as_do_set_mode() -> None:
    station = ready()
    heard = station.tick(dialect.MAVLink_set_mode_message(SYSTEM, 1, Mode.LAND))
    assert [(m.command, m.result) for m in heard if m.get_type() == "COMMAND_ACK"] == [(176, ACCEPTED)]
    assert station.mode is Mode.LAND


@pytest.mark.parametrize(("main", "sub", "text"), [(9, 0, ""), (4, 33, "Unsupported auto mode"), (0, 0, "")])
def test_a_mode_that_is_none_is_rejected(main: int, sub: int, text: str) -> None:
    station = ready()
    assert station.order(176, 1, main, sub) == REJECTED
    assert station.mode is Mode.HOLD
    assert (text in station.texts()) is bool(text)


def test_auto_without_a_sub_mode_is_mission() -> None:
    station = ready()
    assert station.order(176, 1, 4, 0) == ACCEPTED
    assert station.mode is Mode.MISSION


def test_it_tells_when_it_is_ready_and_not_before() -> None:
    station = Px4Station(VehicleConfig(flavor="px4", boot_s=10.0))
    station.tick(seconds=9.5)
    assert station.order(400, 1) == REJECTED
    assert station.texts()[0] == "Arming denied: Resolve system health failures first"
    assert "Preflight Fail: No valid position estimate" in station.texts()
    assert not station.last("SYS_STATUS").onboard_control_sensors_health & 0x10000000
    station.tick(seconds=2.0)
    assert "Ready for takeoff!" in station.texts()
    assert station.last("SYS_STATUS").onboard_control_sensors_health & 0x10000000
    assert station.order(400, 1) == ACCEPTED


@pytest.mark.parametrize(
    ("mode", "reason"),
    [
        (Mode.OFFBOARD, "No offboard signal"),
        (Mode.MISSION, "No valid mission available"),
        (Mode.POSCTL, "No manual control input"),
        (Mode.STABILIZED, "No manual control input"),
        (Mode.RTL, "Mode Return does not allow arming"),
        (Mode.LAND, "Mode Land does not allow arming"),
    ],
)
def test_it_does_not_arm_in_a_mode_that_cannot_be_flown_even_when_forced(mode: Mode, reason: str) -> None:
    station = ready()
    assert station.choose(mode) == ACCEPTED
    assert station.order(400, 1, 21196) == REJECTED
    assert station.texts()[-1] == f"Preflight Fail: {reason}"


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("SIM_GPS_DISABLE", 1.0, "GPS fix too low"),
        ("SIM_MAG1_FAIL", 1.0, "Compass Sensor 0 missing"),
    ],
)
def test_a_broken_sensor_is_a_reason(name: str, value: float, reason: str) -> None:
    station = ready()
    station.pilot.parameters.suffer(name, value)
    station.tick()
    assert station.order(400, 1) == REJECTED
    assert f"Preflight Fail: {reason}" in station.texts()


def test_a_ground_station_is_missed_where_its_loss_would_act() -> None:
    station = ready()
    station.set("NAV_DLL_ACT", 2, 6)
    assert station.order(400, 1) == REJECTED
    assert station.texts()[-1] == "Preflight Fail: No connection to the GCS"
    station.tick(dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
    assert station.order(400, 1) == ACCEPTED


def test_armed_on_the_ground_it_disarms_after_ten_seconds() -> None:
    station = ready()
    assert station.order(400, 1) == ACCEPTED
    station.tick(seconds=9.5)
    assert station.pilot.armed
    station.tick(seconds=1.0)
    assert not station.pilot.armed
    assert station.texts()[-2:] == ["Armed by external command", "Disarmed by auto preflight disarming"]


def test_it_does_not_disarm_in_the_air_unless_forced() -> None:
    station = flying()
    assert station.order(400, 0) == REJECTED
    assert station.texts()[-1] == "Disarming denied: not landed"
    assert station.order(400, 0, 21196) == ACCEPTED
    assert not station.pilot.armed
    assert station.order(400, 2) == UNSUPPORTED


@pytest.mark.parametrize(
    ("altitude_m", "height_m", "text"),
    [
        (HOME.altitude_m + 7.0, 7.0, ""),
        (nan, 2.5, ""),
        (HOME.altitude_m + 1.0, 2.5, "Using minimum takeoff altitude: 2.50 m"),
        (-1e30, 2.5, "Using minimum takeoff altitude: 2.50 m"),
    ],
)
def test_a_takeoff_goes_above_the_sea_or_a_little_above_here(altitude_m: float, height_m: float, text: str) -> None:
    station = ready()
    assert station.order(400, 1) == ACCEPTED
    assert station.order(22, 0, 0, 0, nan, nan, nan, altitude_m) == ACCEPTED
    station.tick(seconds=0.2)
    assert station.mode is Mode.TAKEOFF
    station.tick(seconds=14.0)
    assert station.mode is Mode.HOLD
    assert -station.vehicle.truth.position_ned_m[2] == pytest.approx(height_m, abs=0.1)
    assert (text in station.texts()) is bool(text)


def test_a_takeoff_may_be_chosen_first_and_begins_with_arming() -> None:
    station = ready()
    assert station.order(22, 0, 0, 0, nan, nan, nan, HOME.altitude_m + 6.0) == ACCEPTED
    station.tick(seconds=3.0)
    assert station.vehicle.truth.on_ground
    assert station.order(400, 1) == ACCEPTED
    station.tick(seconds=10.0)
    assert -station.vehicle.truth.position_ned_m[2] == pytest.approx(6.0, abs=0.1)
    assert (station.mode, station.texts()[-1]) == (Mode.HOLD, "Takeoff detected")


@pytest.mark.parametrize(("frame", "z"), [(0, HOME.altitude_m + 15.0), (6, 15.0), (0, nan)])
def test_reposition_is_a_hold_elsewhere(frame: int, z: float) -> None:
    station = flying()
    x, y = round((HOME.latitude_deg + 10.0 / DEGREE_M) * 1e7), round(HOME.longitude_deg * 1e7)
    goto = dialect.MAVLink_command_int_message(SYSTEM, 1, frame, 192, 0, 0, -1, 1, 0, nan, x, y, z)
    assert [m.result for m in station.tick(goto) if m.get_type() == "COMMAND_ACK"] == [ACCEPTED]
    station.tick(seconds=15.0)
    north, east, down = station.vehicle.truth.position_ned_m
    assert hypot(north - 10.0, east) < 0.3
    assert -down == pytest.approx(10.0 if z != z else 15.0, abs=0.3)
    assert station.mode is Mode.HOLD


@pytest.mark.parametrize(
    ("params", "result"),
    [
        ((-1, 0, 0, nan, nan, nan, nan), UNSUPPORTED),  # without the change of mode
        ((-1, 3, 0, nan, nan, nan, nan), UNSUPPORTED),
        ((-1, 1, 0, nan, 95.0, 8.0, 500.0), DENIED),
        ((nan, 1, 0, nan, nan, nan, nan), ACCEPTED),
    ],
)
def test_a_reposition_asks_for_the_mode_and_for_a_place_on_the_globe(params: tuple[float, ...], result: int) -> None:
    assert flying().order(192, *params) == result


def test_a_return_climbs_goes_home_descends_lands_and_disarms() -> None:
    station = flying()
    station.set("RTL_RETURN_ALT", 20.0)
    x, y = HOME.latitude_deg + 30.0 / DEGREE_M, HOME.longitude_deg
    assert station.order(192, -1, 1, 0, nan, x, y, HOME.altitude_m + 10.0) == ACCEPTED
    station.tick(seconds=20.0)
    assert station.order(20) == ACCEPTED
    heights, landing_from_m = [], 0.0
    while station.pilot.armed and station.now_s < 120.0:
        station.tick(seconds=0.5)
        heights.append(-station.vehicle.truth.position_ned_m[2])
        if station.pilot.guidance.landing and not landing_from_m:
            landing_from_m = heights[-1]
    assert max(heights) == pytest.approx(20.0, abs=0.5)
    assert landing_from_m == pytest.approx(10.0, abs=0.7)  # RTL_DESCEND_ALT
    north, east, _ = station.vehicle.truth.position_ned_m
    assert hypot(north, east) < 0.6
    assert "Returning to launch" in station.texts()
    assert station.texts()[-2:] == ["Landing detected", "Disarmed by landing"]
    assert station.mode is Mode.HOLD  # the last one that it may be armed in


@pytest.mark.parametrize(("away_m", "height_m"), [(5.0, 10.0), (15.0, 15.0), (60.0, 30.0)])
def test_a_near_return_stays_in_its_cone(away_m: float, height_m: float) -> None:
    """Within RTL_MIN_DIST it is RTL_DESCEND_ALT, then a cone of 45 degrees up to RTL_RETURN_ALT."""
    station = flying(height_m=4.0)
    east = HOME.longitude_deg + away_m / DEGREE_M / cos(radians(HOME.latitude_deg))
    assert station.order(192, 10.0, 1, 0, nan, HOME.latitude_deg, east, HOME.altitude_m + 4.0) == ACCEPTED
    station.tick(seconds=30.0)
    assert station.order(20) == ACCEPTED
    heights = []
    for _ in range(40):
        station.tick(seconds=0.5)
        heights.append(-station.vehicle.truth.position_ned_m[2])
    assert max(heights) == pytest.approx(height_m, abs=0.6)


def test_modes_that_fly_by_themselves_cruise_and_offboard_does_not() -> None:
    station = flying()
    limits = station.pilot.guidance.limits_in
    assert limits(Mode.HOLD).speed_m_s == 5.0  # MPC_XY_CRUISE
    assert limits(Mode.TAKEOFF).climb_m_s == 1.5  # MPC_TKO_SPEED
    assert limits(Mode.OFFBOARD).speed_m_s == 10.0  # MPC_XY_VEL_MAX: the vehicle's limit
    station.set("MPC_XY_CRUISE", 3.0)
    assert station.pilot.airframe.limits.speed_m_s == 3.0


def test_words_name_every_mode_once() -> None:
    assert len({row.word for row in MODES.values()}) == len(Mode)


def test_what_cannot_lift_off_disarms_all_the_same() -> None:
    station = ready()
    station.pilot.parameters.suffer("SIM_ENGINE_MUL", 0.0)
    assert station.order(400, 1) == ACCEPTED
    assert station.order(22, 0, 0, 0, nan, nan, nan, nan) == ACCEPTED
    station.tick(seconds=15.0)
    assert not station.pilot.armed
