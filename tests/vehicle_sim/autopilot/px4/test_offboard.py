"""OFFBOARD: what it needs to be entered and to stay, what ends it, and which axes of a setpoint count."""

from __future__ import annotations

from math import nan, pi

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import SYSTEM, velocity
from tests.vehicle_sim.autopilot.px4.station import ACCEPTED, INTEGER, REJECTED, flying, in_offboard, ready
from vehicle_sim.autopilot.px4.modes import Mode

POSITION = {"x": 0x001, "y": 0x002, "z": 0x004}
ALL_IGNORED = 0xFFF


def test_in_the_air_it_needs_a_setpoint_younger_than_a_second() -> None:
    station = flying()
    assert station.choose(Mode.OFFBOARD) == REJECTED
    station.tick(velocity(0.0))
    station.tick(seconds=0.8)
    assert station.choose(Mode.OFFBOARD) == ACCEPTED
    station = flying()
    station.tick(velocity(0.0))
    station.tick(seconds=1.2)
    assert station.choose(Mode.OFFBOARD) == REJECTED
    assert station.mode is Mode.HOLD


def test_a_setpoint_with_nothing_in_it_is_no_sign_of_life() -> None:
    station = flying()
    station.tick(velocity(0.0, mask=ALL_IGNORED))
    station.tick(velocity(nan, nan, nan))
    assert station.choose(Mode.OFFBOARD) == REJECTED


# COM_OBL_RC_ACT without a pilot -> the mode flown then. What needs a pilot is the action for a lost one, RTL.
LOSSES = [(0, Mode.RTL), (1, Mode.RTL), (2, Mode.RTL), (3, Mode.RTL), (4, Mode.LAND), (5, Mode.HOLD)]


@pytest.mark.parametrize(("action", "mode"), LOSSES)
def test_when_setpoints_stop_it_leaves_within_a_second_and_comes_back_with_them(action: int, mode: Mode) -> None:
    station = in_offboard(3.0)
    station.set("COM_OBL_RC_ACT", action, INTEGER)
    station.stream_velocity(3.0, seconds=2.0)
    station.tick(seconds=0.9)
    assert station.mode is Mode.OFFBOARD
    station.tick(seconds=0.3)
    assert (station.mode, station.texts()[-1]) == (mode, "Failsafe activated")
    assert station.last("HEARTBEAT").system_status == 5
    station.tick(velocity(0.0))
    assert station.mode is Mode.OFFBOARD
    assert station.last("HEARTBEAT").system_status == 4


@pytest.mark.parametrize("action", [6, 7])
def test_it_can_be_told_to_stop_its_motors(action: int) -> None:
    station = in_offboard()
    station.set("COM_OBL_RC_ACT", action, INTEGER)
    station.tick(seconds=1.5)
    assert not station.pilot.armed
    assert station.texts()[-1] == "Disarmed by failsafe"


def test_with_a_pilot_it_leaves_for_the_pilots_mode() -> None:
    station = in_offboard()
    hands = dialect.MAVLink_manual_control_message(SYSTEM, 0, 0, 500, 0, 0)
    for _ in range(15):
        station.tick(hands)
    assert station.mode is Mode.POSCTL


def test_a_person_who_chooses_a_mode_while_it_is_lost_takes_over() -> None:
    station = in_offboard()
    station.tick(seconds=1.5)
    assert station.mode is Mode.RTL
    assert station.choose(Mode.HOLD) == ACCEPTED
    station.stream_velocity(3.0, seconds=2.0)
    assert station.mode is Mode.HOLD


def test_it_lifts_off_by_itself_and_only_when_the_setpoint_leads_up() -> None:
    station = ready()
    station.stream_velocity(1.0, seconds=0.3)
    assert station.choose(Mode.OFFBOARD) == ACCEPTED
    assert station.order(400, 1) == ACCEPTED
    station.stream_velocity(1.0, seconds=2.0)
    assert station.vehicle.truth.on_ground
    station.stream_velocity(0.0, 0.0, -1.0, seconds=4.0)
    assert station.vehicle.truth.position_ned_m[2] < -2.0
    assert station.mode is Mode.OFFBOARD


def setpoint(mask: int, *, frame: int = 1, position: float = 5.0, speed: float = 2.0, yaw: float = 0.0) -> object:
    return dialect.MAVLink_set_position_target_local_ned_message(
        0, SYSTEM, 1, frame, mask, position, position, -12.0, speed, speed, 0.0, nan, nan, nan, yaw, 0.0
    )


@pytest.mark.parametrize(
    ("mask", "north_m", "east_m", "height_m"),
    [
        (0xDF8, 5.0, 5.0, 12.0),  # a position, all of it
        (0xDFC, 5.0, 5.0, 10.0),  # without its height: that stays
        (0xDFB, 0.0, 0.0, 12.0),  # its height alone
        (0xDFA, 0.0, 0.0, 12.0),  # half a plane is none
        (0xFFB, 0.0, 0.0, 12.0),
    ],
)
def test_the_mask_is_per_axis(mask: int, north_m: float, east_m: float, height_m: float) -> None:
    station = in_offboard()
    for _ in range(120):
        station.tick(setpoint(mask))
    north, east, down = station.vehicle.truth.position_ned_m
    assert (north, east, -down) == pytest.approx((north_m, east_m, height_m), abs=0.3)


def test_velocity_and_height_go_together() -> None:
    """x and y velocities with a z position: what MAVSDK's set_position_velocity is made of."""
    station = in_offboard()
    for _ in range(80):
        station.tick(setpoint(0xDC3))
    assert station.vehicle.truth.velocity_ned_m_s[:2] == pytest.approx((2.0, 2.0), abs=0.1)
    assert -station.vehicle.truth.position_ned_m[2] == pytest.approx(12.0, abs=0.2)


def test_the_body_frame_turns_with_the_nose() -> None:
    station = in_offboard()
    for _ in range(60):
        station.tick(velocity(0.0, yaw=pi / 2, mask=0x9C7))
    for _ in range(40):
        station.tick(velocity(2.0, frame=8))
    assert station.vehicle.truth.velocity_ned_m_s == pytest.approx((0.0, 2.0, 0.0), abs=0.15)


@pytest.mark.parametrize("frame", [0, 2, 7, 9, 12, 255])
def test_other_frames_are_said_and_not_flown(frame: int) -> None:
    station = in_offboard()
    for _ in range(12):
        station.tick(velocity(3.0, frame=frame))
    assert f"Setpoint coordinate frame {frame} unsupported" in station.texts()
    assert station.mode is Mode.RTL  # no sign of life


@pytest.mark.parametrize(("thrust", "sign"), [(0.5, 0), (0.8, 1), (0.2, -1)])
def test_thrust_climbs_above_the_hover(thrust: float, sign: int) -> None:
    station = in_offboard()
    level = dialect.MAVLink_set_attitude_target_message(0, SYSTEM, 1, 7, [1.0, 0.0, 0.0, 0.0], 0, 0, 0, thrust)
    for _ in range(15):
        station.tick(level)
    climb_m_s = -station.vehicle.truth.velocity_ned_m_s[2]
    assert (climb_m_s > 0.3) - (climb_m_s < -0.3) == sign
    assert station.mode is Mode.OFFBOARD
