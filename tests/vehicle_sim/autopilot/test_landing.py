"""LAND, RTL and the ground station failsafe, with the recorded speeds, delays and texts."""

from __future__ import annotations

from itertools import pairwise

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import GUIDED, LAND, RTL, GroundStation, flying, position, velocity

ON_GROUND, IN_AIR, LANDING = 1, 2, 4


def until_disarmed(station: GroundStation, *, longest_s: float = 200.0) -> list[tuple[float, float]]:
    """(seconds, height) until it disarms."""
    heights = []
    while station.vehicle.truth.armed and station.now_s < longest_s:
        station.tick()
        heights.append((station.now_s, -station.vehicle.truth.position_ned_m[2]))
    return heights


def set_param(station: GroundStation, name: bytes, value: float) -> None:
    station.tick(dialect.MAVLink_param_set_message(3, 1, name, value, 9))


def test_land_has_two_speeds_and_disarms_itself() -> None:
    station = flying(altitude_m=25.0)
    station.tick(seconds=15.0)
    station.stream(245)
    assert station.order(176, 1, LAND) == 0
    assert station.last("HEARTBEAT").base_mode == 209
    heights = until_disarmed(station)
    speeds = [(high, (high - low) / 0.1) for (_, high), (_, low) in pairwise(heights)]
    assert max(speed for _, speed in speeds) == pytest.approx(1.5, abs=0.05)
    assert [speed for height, speed in speeds if 1.0 < height < 8.0] == pytest.approx(
        [0.5] * sum(1.0 < height < 8.0 for height, _ in speeds), abs=0.02
    )
    touched_s = next(at_s for at_s, height in heights if height == 0.0)
    texts = {text.text: at_s for at_s, text in station.all("STATUSTEXT")}
    assert texts["SIM Hit ground at 0.5 m/s"] == touched_s
    assert texts["Disarming motors"] - touched_s == pytest.approx(2.1, abs=0.11)
    assert list(dict.fromkeys(state.landed_state for _, state in station.all("EXTENDED_SYS_STATE"))) == [
        IN_AIR, LANDING, ON_GROUND,
    ]  # fmt: skip
    beat = station.last("HEARTBEAT")
    assert (beat.base_mode, beat.custom_mode, beat.system_status) == (81, LAND, 3)


def test_rtl_climbs_flies_home_waits_lands_and_disarms() -> None:
    station = flying()
    for _ in range(150):
        station.tick(velocity(2.0, 1.0))
    far_m = station.vehicle.truth.position_ned_m[0]
    assert station.order(20) == 0
    assert station.last("HEARTBEAT").custom_mode == RTL
    while -station.vehicle.truth.position_ned_m[2] < 14.7:
        station.tick()
        assert abs(station.vehicle.truth.position_ned_m[0] - far_m) < 3.0  # up first
    heights = until_disarmed(station)
    assert max(height for _, height in heights) == pytest.approx(15.0, abs=0.1)  # RTL_ALT
    assert station.vehicle.truth.on_ground
    assert station.vehicle.truth.position_ned_m == pytest.approx((0.0, 0.0, 0.0), abs=0.3)
    assert station.texts()[-2:] == ["SIM Hit ground at 0.5 m/s", "Disarming motors"]


def test_rtl_from_above_rtl_alt_stays_up_and_rtl_alt_is_a_parameter() -> None:
    station = flying(altitude_m=20.0)
    station.tick(seconds=10.0)
    station.order(20)
    station.tick(seconds=3.0)
    assert -station.vehicle.truth.position_ned_m[2] == pytest.approx(20.0, abs=0.1)
    station.order(176, 1, GUIDED)
    for _ in range(100):
        station.tick(velocity(2.0))  # out of the cone above home, in which it need not climb
    set_param(station, b"RTL_ALT", 3000.0)
    station.order(20)
    heights = until_disarmed(station)
    assert max(height for _, height in heights) == pytest.approx(30.0, abs=0.2)


def test_rtl_near_home_climbs_no_higher_than_the_cone() -> None:
    station = flying(altitude_m=3.0)
    station.tick(position(2.0, 0.0, -3.0), seconds=10.0)
    station.order(20)
    heights = until_disarmed(station)
    assert max(height for _, height in heights) == pytest.approx(6.0, abs=0.3)  # RTL_CONE_SLOPE 3 times 2 m


def test_rtl_alt_final_stays_there() -> None:
    station = flying()
    set_param(station, b"RTL_ALT_FINAL", 500.0)
    station.order(20)
    station.tick(seconds=60.0)
    assert station.vehicle.truth.armed
    assert -station.vehicle.truth.position_ned_m[2] == pytest.approx(5.0, abs=0.05)


def test_landing_by_setpoint_disarms_after_disarm_delay() -> None:
    station = flying(altitude_m=2.0)
    while not station.vehicle.truth.on_ground:
        station.tick(velocity(0.0, 0.0, 0.5))
    touched_s = station.now_s
    until_disarmed(station)
    assert station.now_s - touched_s == pytest.approx(10.0, abs=0.11)


def test_stabilize_without_a_pilot_falls() -> None:
    station = flying()
    station.order(176, 1, 0)
    station.tick(seconds=3.0)
    assert station.vehicle.truth.on_ground


def test_gcs_failsafe_lands_after_its_timeout_and_stays_landing() -> None:
    station = flying()
    beat = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    station.tick(beat)
    station.tick(seconds=20.0)
    assert station.vehicle.mode_name == "GUIDED"  # off by default
    station.tick(beat)
    heard_s = station.now_s - 0.1
    set_param(station, b"FS_GCS_ENABLE", 5.0)
    while station.vehicle.mode_name == "GUIDED":
        station.tick()
    assert station.now_s - heard_s == pytest.approx(5.0, abs=0.25)
    assert station.texts()[-1] == "GCS Failsafe"
    assert (station.last("HEARTBEAT").custom_mode, station.last("HEARTBEAT").system_status) == (LAND, 5)
    station.tick(beat)
    assert station.texts()[-1] == "GCS Failsafe Cleared"
    assert (station.last("HEARTBEAT").custom_mode, station.last("HEARTBEAT").system_status) == (LAND, 4)


def test_another_ground_station_does_not_feed_the_failsafe() -> None:
    station = flying()
    set_param(station, b"SYSID_MYGCS", 250.0)
    set_param(station, b"FS_GCS_ENABLE", 1.0)
    for _ in range(100):
        station.tick(dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
    assert station.vehicle.mode_name == "GUIDED"  # never heard, never lost
