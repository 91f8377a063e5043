"""GUIDED flight: takeoff, setpoints, their masks and frames, and what happens when they stop."""

from __future__ import annotations

from math import hypot, inf, nan, pi

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import (
    HOME,
    RTL,
    VELOCITY_YAW,
    VELOCITY_YAW_RATE,
    GroundStation,
    flying,
    position,
    ready,
    velocity,
)
from vehicle_sim.vehicle import VehicleConfig
from vehicle_sim.wind import Wind

ON_GROUND, IN_AIR, TAKING_OFF = 1, 2, 3


def height_m(station: GroundStation) -> float:
    return -station.vehicle.truth.position_ned_m[2]


def speed_m_s(station: GroundStation) -> float:
    return hypot(*station.vehicle.truth.velocity_ned_m_s[:2])


def test_takeoff_to_ten_meters_as_recorded() -> None:
    station = ready()
    station.stream(245)
    station.order(400, 1)
    began_s = station.now_s
    assert station.order(22, 0, 0, 0, 0, 0, 0, 10) == 0
    heights = []
    for _ in range(100):
        station.tick()
        heights.append((station.now_s - began_s, height_m(station)))
    off_ground_s = next(at_s for at_s, height in heights if height > 0.3)
    nearly_s = next(at_s for at_s, height in heights if height > 9.5)
    settled_s = next(at_s for at_s, height in heights if height > 9.9)
    assert off_ground_s == pytest.approx(1.8, abs=0.2)
    assert nearly_s == pytest.approx(7.0, abs=0.4)
    assert settled_s == pytest.approx(8.2, abs=0.4)
    assert max(height for _, height in heights) < 10.05
    assert height_m(station) == pytest.approx(10.0, abs=0.05)
    states = [(at_s - began_s, state.landed_state) for at_s, state in station.all("EXTENDED_SYS_STATE")]
    assert list(dict.fromkeys(state for _, state in states)) == [ON_GROUND, TAKING_OFF, IN_AIR]
    assert next(at_s for at_s, state in states if state == TAKING_OFF) == pytest.approx(1.0, abs=0.15)
    assert (station.last("HEARTBEAT").base_mode, station.last("HEARTBEAT").system_status) == (217, 4)
    assert station.texts()[-2:] == [
        "EKF3 IMU1 MAG0 in-flight yaw alignment complete",
        "EKF3 IMU0 MAG0 in-flight yaw alignment complete",
    ]


def test_setpoints_on_the_ground_and_during_takeoff_are_ignored() -> None:
    station = ready()
    station.order(400, 1)
    for _ in range(20):
        station.tick(velocity(2.0, 0.0, -1.0))
    assert station.vehicle.truth.on_ground
    station.order(22, 0, 0, 0, 0, 0, 0, 10)
    for _ in range(40):
        station.tick(velocity(2.0))
    assert speed_m_s(station) == 0.0
    assert height_m(station) > 2.0


def test_a_takeoff_leads_up_wherever_home_is() -> None:
    station = ready()
    station.order(400, 1)
    assert station.order(179, 0, 0, 0, 0, HOME.latitude_deg, HOME.longitude_deg, HOME.altitude_m - 5.0) == 0
    assert station.order(22, 0, 0, 0, 0, 0, 0, 4.9) == 4
    assert station.order(22, 0, 0, 0, 0, 0, 0, 8.0) == 0
    station.tick(seconds=8.0)
    assert height_m(station) == pytest.approx(3.0, abs=0.1)


def test_a_setpoint_acts_from_the_beginning_of_its_tick() -> None:
    station = flying(VehicleConfig(kind="ideal"))
    before = station.vehicle.truth.position_ned_m
    station.tick(velocity(3.0, -1.0))
    north, east, _ = station.vehicle.truth.position_ned_m
    assert (north - before[0], east - before[1]) == (pytest.approx(0.3), pytest.approx(-0.1))
    assert station.vehicle.truth.velocity_ned_m_s == (3.0, -1.0, 0.0)


def test_a_velocity_expires_after_three_seconds_without_a_word() -> None:
    station = flying()
    for _ in range(80):
        station.tick(velocity(3.0))
    said = len(station.texts())
    began_m = station.vehicle.truth.position_ned_m[0] - 0.3  # where the last setpoint began to act
    station.tick(seconds=2.9)
    assert speed_m_s(station) == pytest.approx(3.0, abs=0.05)
    station.tick(seconds=6.0)
    assert speed_m_s(station) < 0.05
    assert station.vehicle.truth.position_ned_m[0] - began_m == pytest.approx(11.66, abs=0.4)
    assert station.vehicle.mode_name == "GUIDED"
    assert len(station.texts()) == said


@pytest.mark.parametrize(
    "bad",
    [
        velocity(nan),
        velocity(inf),
        velocity(1e6),
        velocity(2.0, frame=99),
        velocity(2.0, mask=0xFFF),
        velocity(2.0, mask=0xDC7 | 0x010),  # one bit of the velocity's three is enough
        velocity(2.0, mask=VELOCITY_YAW, yaw=nan),
        velocity(2.0, mask=VELOCITY_YAW_RATE, yaw_rate=inf),
        position(nan, 0.0, -10.0),
        position(1e9, 0.0, -10.0),
    ],
)
def test_a_bad_setpoint_stops_it(bad: object) -> None:
    station = flying()
    for _ in range(40):
        station.tick(velocity(2.0))
    for _ in range(40):
        station.tick(bad)
    assert speed_m_s(station) < 0.05
    assert station.vehicle.mode_name == "GUIDED"
    assert height_m(station) == pytest.approx(10.0, abs=0.1)


def test_who_a_setpoint_is_for() -> None:
    station = flying()
    for _ in range(20):
        station.tick(velocity(2.0, system=77))
    assert speed_m_s(station) < 0.01
    for _ in range(40):
        station.tick(velocity(2.0, system=0))
    assert speed_m_s(station) > 1.5


@pytest.mark.parametrize(("frame", "expected"), [(1, (2.0, 0.0)), (7, (2.0, 0.0)), (8, (0.0, 2.0)), (9, (0.0, 2.0))])
def test_velocity_frames(frame: int, expected: tuple[float, float]) -> None:
    """With the nose east, forward is east in the body frames."""
    station = flying(VehicleConfig(kind="ideal"), heading_rad=pi / 2)
    station.tick(velocity(2.0, frame=frame))
    assert station.vehicle.truth.velocity_ned_m_s[:2] == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(
    ("frame", "expected"), [(1, (20.0, 5.0)), (7, (50.0, 5.0)), (8, (25.0, 20.0)), (9, (25.0, 20.0))]
)
def test_position_frames(frame: int, expected: tuple[float, float]) -> None:
    """From 30 m north: LOCAL is from home, the others from here; BODY turns with the nose (east)."""
    station = flying(VehicleConfig(kind="ideal"), heading_rad=pi / 2)
    station.tick(position(30.0, 0.0, -10.0), seconds=30.0)
    station.tick(position(20.0, 5.0, -10.0 if frame == 1 else 0.0, frame=frame), seconds=30.0)
    assert station.vehicle.truth.position_ned_m[:2] == pytest.approx(expected, abs=0.05)
    assert height_m(station) == pytest.approx(10.0, abs=0.05)


def test_a_position_is_flown_to_and_held_without_more_words() -> None:
    station = flying()
    began_s = station.now_s
    station.tick(position(120.0, 20.0, -10.0))
    while hypot(station.vehicle.truth.position_ned_m[0] - 120.0, station.vehicle.truth.position_ned_m[1] - 20.0) > 1.0:
        station.tick()
    assert station.now_s - began_s == pytest.approx(17.0, abs=5.0)  # recorded for 121.6 m
    station.tick(seconds=10.0)
    assert station.vehicle.truth.position_ned_m == pytest.approx((120.0, 20.0, -10.0), abs=0.05)


@pytest.mark.parametrize(
    ("frame", "altitude_m"), [(5, HOME.altitude_m + 15.0), (6, 15.0), (0, HOME.altitude_m + 15.0), (3, 15.0)]
)
def test_global_positions(frame: int, altitude_m: float) -> None:
    station = flying()
    latitude, longitude = HOME.latitude_deg + 20.0 / 111319.49079327357, HOME.longitude_deg
    station.tick(
        dialect.MAVLink_set_position_target_global_int_message(
            0, 3, 1, frame, 0xDF8, round(latitude * 1e7), round(longitude * 1e7), altitude_m, 0, 0, 0, 0, 0, 0, 0, 0
        ),
        seconds=25.0,
    )
    assert station.vehicle.truth.position_ned_m == pytest.approx((20.0, 0.0, -15.0), abs=0.1)


def test_yaw_turns_to_the_angle_and_at_the_rate() -> None:
    station = flying()
    for _ in range(60):
        station.tick(velocity(0.0, mask=VELOCITY_YAW, yaw=2.0))
    assert station.vehicle.truth.yaw_rad == pytest.approx(2.0, abs=0.01)
    before = station.vehicle.truth.yaw_rad
    for _ in range(10):
        station.tick(velocity(0.0, mask=VELOCITY_YAW_RATE, yaw_rate=0.5))
    assert station.vehicle.truth.yaw_rad - before == pytest.approx(0.5, abs=0.01)


def test_limits_hold_for_what_a_setpoint_asks() -> None:
    station = flying(VehicleConfig(kind="ideal"))
    station.tick(velocity(30.0, 40.0, -9.0))
    assert station.vehicle.truth.velocity_ned_m_s == pytest.approx((6.0, 8.0, -2.5))
    station.order(178, 1, 5)  # DO_CHANGE_SPEED
    station.tick(velocity(30.0, 40.0, 9.0))
    assert station.vehicle.truth.velocity_ned_m_s == pytest.approx((3.0, 4.0, 1.5))


def test_the_same_seed_gives_the_same_bytes_and_gusts_stay_near() -> None:
    config = VehicleConfig(wind=Wind(speed_m_s=5.0, from_deg=40.0, gust_m_s=2.0))
    one, other, third = (flying(config, seed=seed) for seed in (4, 4, 5))
    for station in (one, other, third):
        station.stream(32, 30)
        station.tick(seconds=20.0)
        assert hypot(*station.vehicle.truth.position_ned_m[:2]) < 3.0
    assert [bytes(m.get_msgbuf()) for _, m in one.log] == [bytes(m.get_msgbuf()) for _, m in other.log]
    assert one.vehicle.truth != third.vehicle.truth


def test_setpoints_count_in_guided_alone() -> None:
    station = flying()
    station.order(176, 1, 17)  # BRAKE
    for _ in range(20):
        station.tick(velocity(3.0))
    assert speed_m_s(station) < 0.01
    station.order(176, 1, RTL)
    station.tick(velocity(3.0))
    assert station.vehicle.mode_name == "RTL"
