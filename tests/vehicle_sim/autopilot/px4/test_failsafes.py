"""What a PX4 does when its ground station, pilot, battery, position or border is lost."""

from __future__ import annotations

from math import nan

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import HOME, SYSTEM
from tests.vehicle_sim.autopilot.px4.station import ACCEPTED, BEAT, INTEGER, REJECTED, Px4Station, flying
from vehicle_sim.autopilot.px4.modes import Mode

HOLDING = "Failsafe activated: entering Hold for 5 seconds"


def lose_gcs(action: int) -> Px4Station:
    station = flying()
    station.tick(BEAT)
    station.set("NAV_DLL_ACT", action, INTEGER)
    station.tick(BEAT)
    station.tick(seconds=9.8)
    assert not station.pilot.failsafes.active
    station.tick(seconds=0.6)
    return station


@pytest.mark.parametrize(("action", "mode"), [(2, Mode.RTL), (3, Mode.LAND)])
def test_a_lost_ground_station_is_held_for_and_then_acted_on(action: int, mode: Mode) -> None:
    station = lose_gcs(action)
    assert (station.mode, station.texts()[-1]) == (Mode.HOLD, HOLDING)
    station.tick(seconds=4.0)
    assert station.mode is Mode.HOLD
    station.tick(seconds=1.0)
    assert station.mode is mode
    station.tick(BEAT)
    station.tick(seconds=1.0)
    assert station.mode is mode  # it goes on when the ground station is back


def test_a_lost_ground_station_can_be_ignored_and_can_be_the_end() -> None:
    assert lose_gcs(0).texts()[-1] == "Takeoff detected"
    assert not lose_gcs(6).pilot.armed


def test_any_ground_station_counts_and_nothing_else_does() -> None:
    station = flying()
    station.tick(BEAT)
    station.set("NAV_DLL_ACT", 2, INTEGER)
    for _ in range(110):
        station.tick(dialect.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3))  # an onboard computer
    assert station.mode is Mode.HOLD
    assert station.pilot.failsafes.active


def test_a_person_takes_over_by_choosing_a_mode() -> None:
    station = lose_gcs(2)
    assert station.choose(Mode.LAND) == ACCEPTED
    station.tick(seconds=3.0)
    assert station.mode is Mode.LAND
    assert not station.pilot.failsafes.active


def test_a_pilot_is_missed_only_if_there_was_one() -> None:
    station = flying()
    station.tick(seconds=20.0)
    assert not station.pilot.failsafes.active
    hands = dialect.MAVLink_manual_control_message(SYSTEM, 0, 0, 500, 0, 0)
    for _ in range(5):
        station.tick(hands)
    assert station.choose(Mode.POSCTL) == ACCEPTED
    for _ in range(5):
        station.tick(hands)
    assert station.mode is Mode.POSCTL
    station.tick(seconds=0.8)
    assert station.mode is not Mode.POSCTL
    station.tick(seconds=6.0)
    assert station.mode is Mode.RTL


def drain(station: Px4Station, share: float) -> None:
    station.pilot.charge.consumed_mah = (1.0 - share) * station.pilot.parameters["BAT1_CAPACITY"]
    station.tick(seconds=0.2)


# COM_LOW_BAT_ACT: what it does at 10, 6.5 and 4 percent, once it has held.
@pytest.mark.parametrize(
    ("action", "modes"),
    [
        (0, (Mode.HOLD, Mode.HOLD, Mode.HOLD)),
        (2, (Mode.HOLD, Mode.LAND, Mode.LAND)),
        (3, (Mode.HOLD, Mode.RTL, Mode.LAND)),
    ],
)
def test_a_battery_runs_low(action: int, modes: tuple[Mode, ...]) -> None:
    station = flying(height_m=40.0)
    station.set("SIM_BAT_MIN_PCT", 0.0)
    station.set("COM_LOW_BAT_ACT", action, INTEGER)
    seen = []
    for share in (0.10, 0.065, 0.04):
        drain(station, share)
        station.tick(seconds=5.5)
        seen.append(station.mode)
    assert tuple(seen) == modes
    told = [text for text in station.texts() if "battery level" in text]
    assert told == [
        "Low battery level, return advised",
        "Critical battery level, land now",
        "Emergency battery level, land immediately",
    ]
    assert station.last("BATTERY_STATUS").charge_state == 4


def test_a_simulated_battery_never_says_less_than_it_may() -> None:
    station = flying()
    drain(station, 0.01)
    station.tick(seconds=1.0)
    assert station.last("SYS_STATUS").battery_remaining == 50
    assert not station.pilot.failsafes.active


def test_without_a_position_it_comes_down_where_it_is() -> None:
    station = flying()
    station.set("SYS_FAILURE_EN", 1, INTEGER)
    assert station.order(420, 4, 1) == ACCEPTED  # GPS off
    station.tick(seconds=6.0)
    assert station.mode is Mode.HOLD
    station.tick(seconds=3.0)
    assert station.mode is Mode.LAND
    assert station.choose(Mode.HOLD) == REJECTED
    assert not station.last("SYS_STATUS").onboard_control_sensors_health & 0x20
    station.tick(seconds=30.0)
    assert not station.pilot.armed


@pytest.mark.parametrize(
    ("action", "mode"), [(0, Mode.HOLD), (1, Mode.HOLD), (2, Mode.HOLD), (3, Mode.RTL), (5, Mode.LAND)]
)
def test_beyond_the_geofence(action: int, mode: Mode) -> None:
    station = flying()
    station.set("GF_ACTION", action, INTEGER)
    station.set("GF_MAX_VER_DIST", 8.0)
    station.tick(seconds=5.5)
    assert station.mode is mode
    assert station.pilot.failsafes.active is (action >= 2)
    assert not station.last("SYS_STATUS").onboard_control_sensors_health & 0x100000


def test_beyond_the_radius_and_out_of_an_uploaded_zone() -> None:
    station = flying()
    x, y = round(HOME.latitude_deg * 1e7), round(HOME.longitude_deg * 1e7)
    station.tick(dialect.MAVLink_mission_count_message(SYSTEM, 1, 1, 1))
    station.tick(dialect.MAVLink_mission_item_int_message(SYSTEM, 1, 0, 0, 5003, 0, 1, 20.0, 0, 0, 0, x, y, 0.0, 1))
    assert station.last("MISSION_ACK").type == 0
    assert not station.pilot.geofence.breached
    assert station.order(192, -1, 1, 0, nan, HOME.latitude_deg + 30e-5, HOME.longitude_deg, nan) == ACCEPTED
    station.tick(seconds=12.0)
    assert station.pilot.geofence.breached
    assert station.pilot.failsafes.active


@pytest.mark.parametrize(
    ("unit", "kind", "result"), [(4, 1, 0), (2, 1, 0), (3, 2, 0), (101, 1, 0), (4, 7, 3), (9, 1, 3)]
)
def test_failures_can_be_injected_where_it_is_allowed(unit: int, kind: int, result: int) -> None:
    station = flying()
    assert station.order(420, unit, kind) == 2
    station.set("SYS_FAILURE_EN", 1, INTEGER)
    assert station.order(420, unit, kind) == result
