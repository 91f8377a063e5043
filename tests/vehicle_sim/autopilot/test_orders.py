"""Orders beside setpoints and missions: go there, turn, lean, pause, new home, reboot; and the small answers."""

from __future__ import annotations

from math import cos, nan, pi, radians, sin
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import (
    GUIDED,
    HOME,
    LOITER,
    RTL,
    GroundStation,
    flying,
    position,
    ready,
    velocity,
)
from tests.vehicle_sim.autopilot.test_auto import METERS, TAKEOFF, at, started, until
from vehicle_sim.autopilot.plans.item import Item

ACCEPTED, DENIED, UNSUPPORTED, FAILED = 0, 2, 3, 4
CHANGE_MODE = 1.0


def place(station: GroundStation) -> tuple[float, float, float]:
    return station.vehicle.truth.position_ned_m


def order_int(station: GroundStation, command: int, *params: float, x: int = 0, y: int = 0, z: float = 0.0,
              frame: int = 6) -> int:  # fmt: skip
    """Send a COMMAND_INT with parameters 1 to 4; its result."""
    padded = [*params, *[0.0] * (4 - len(params))]
    heard = station.tick(dialect.MAVLink_command_int_message(3, 1, frame, command, 0, 0, *padded, x, y, z))
    return next(int(m.result) for m in heard if m.get_type() == "COMMAND_ACK")


def north_of_home(meters: float) -> dict[str, int]:
    return {"x": round((HOME.latitude_deg + meters / METERS) * 1e7), "y": round(HOME.longitude_deg * 1e7)}


@pytest.mark.parametrize(("frame", "height"), [(6, 15.0), (3, 15.0), (5, HOME.altitude_m + 15.0), (0, 503.1)])
def test_reposition(frame: int, height: float) -> None:
    station = flying()
    assert order_int(station, 192, -1, 1, frame=frame, z=height, **north_of_home(20.0)) == ACCEPTED
    station.tick(seconds=15.0)
    assert place(station) == pytest.approx((20.0, 0.0, -15.0), abs=0.2)


def test_reposition_from_another_mode_has_to_ask_for_guided() -> None:
    station = flying()
    station.order(176, 1, RTL)
    assert order_int(station, 192, -1, 0, z=10.0, **north_of_home(20.0)) == DENIED
    assert station.last("HEARTBEAT").custom_mode == RTL
    assert order_int(station, 192, -1, CHANGE_MODE, z=10.0, **north_of_home(20.0)) == ACCEPTED
    assert station.last("HEARTBEAT").custom_mode == GUIDED


@pytest.mark.parametrize(
    "wrong",
    [{"z": nan, **north_of_home(5)}, {"z": 10.0}, {"z": 10.0, "frame": 99, **north_of_home(5)}, {"x": 950_000_000}],
)
def test_reposition_to_nowhere_is_denied(wrong: dict[str, Any]) -> None:
    station = flying()
    assert order_int(station, 192, -1, CHANGE_MODE, **wrong) == DENIED
    station.tick(seconds=3.0)
    assert place(station) == pytest.approx((0.0, 0.0, -10.0), abs=0.2)


@pytest.mark.parametrize(("frame", "result"), [(3, ACCEPTED), (6, DENIED), (0, DENIED)])
def test_a_takeoff_as_an_integer_command_counts_from_home(frame: int, result: int) -> None:
    station = ready()
    station.order(400, 1)
    assert order_int(station, 22, z=10.0, frame=frame) == result
    station.tick(seconds=12.0)
    assert place(station)[2] == pytest.approx(-10.0 if result == ACCEPTED else 0.0, abs=0.1)


def test_reposition_ends_a_takeoff_and_is_flown() -> None:
    station = ready()
    station.order(400, 1)
    station.order(22, 0, 0, 0, 0, 0, 0, 40)
    station.tick(seconds=5.0)
    assert order_int(station, 192, -1, 0, z=15.0, **north_of_home(20.0)) == ACCEPTED
    station.tick(seconds=20.0)
    assert place(station) == pytest.approx((20.0, 0.0, -15.0), abs=0.2)


def test_reposition_beyond_the_fence_fails_and_changes_nothing() -> None:
    station = flying()
    for name, value in (("FENCE_TYPE", 3), ("FENCE_RADIUS", 50), ("FENCE_ALT_MAX", 20), ("FENCE_ENABLE", 1)):
        station.tick(dialect.MAVLink_param_set_message(3, 1, name.encode(), value, 9))
    station.order(176, 1, RTL)
    assert order_int(station, 192, -1, CHANGE_MODE, z=10.0, **north_of_home(60.0)) == FAILED
    assert order_int(station, 192, -1, CHANGE_MODE, z=21.0, **north_of_home(5.0)) == FAILED
    assert station.last("HEARTBEAT").custom_mode == RTL
    assert order_int(station, 192, -1, CHANGE_MODE, z=20.0, **north_of_home(5.0)) == ACCEPTED


def test_reposition_as_a_long_command_is_unknown_as_recorded() -> None:
    assert flying().order(192, -1, 1, 0, 0, HOME.latitude_deg, HOME.longitude_deg, 10) == UNSUPPORTED


@pytest.mark.parametrize(
    ("params", "result", "yaw"),
    [
        ((90, 30, 1, 0), ACCEPTED, pi / 2),
        ((45, 0, -1, 1), ACCEPTED, -pi / 4),
        ((400, 0, 1, 0), FAILED, 0.0),
        ((nan, 0, 1, 0), FAILED, 0.0),
        ((90, 0, 1, 7), FAILED, 0.0),
    ],
)
def test_the_nose_turns_and_the_place_is_held(params: tuple[float, ...], result: int, yaw: float) -> None:
    station = flying()
    assert station.order(115, *params) == result
    station.tick(seconds=6.0)
    assert station.vehicle.truth.yaw_rad == pytest.approx(yaw, abs=0.02)
    assert place(station) == pytest.approx((0.0, 0.0, -10.0), abs=0.1)


def attitude(roll: float, pitch: float, yaw: float, thrust: float, mask: int = 0b111) -> Any:
    cr, sr, cp, sp, cy, sy = (f(a / 2.0) for a in (roll, pitch, yaw) for f in (cos, sin))
    q = (cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
         cr * cp * sy - sr * sp * cy)  # fmt: skip
    return dialect.MAVLink_set_attitude_target_message(0, 3, 1, mask, list(q), 0, 0, 0, thrust)


def test_an_attitude_is_flown_and_expires_level() -> None:
    station = flying()
    for _ in range(30):
        station.tick(attitude(0.0, radians(-8.0), 0.0, 0.5))
    north, east, down = station.vehicle.truth.velocity_ned_m_s
    assert north > 1.5
    assert (east, down) == pytest.approx((0.0, 0.0), abs=0.1)
    assert station.vehicle.truth.pitch_rad < -0.1
    for _ in range(20):
        station.tick(attitude(0.0, 0.0, 0.0, 1.0))
    assert station.vehicle.truth.velocity_ned_m_s[2] == pytest.approx(-2.5, abs=0.7)  # WPNAV_SPEED_UP
    station.tick(seconds=10.0)
    assert station.vehicle.truth.velocity_ned_m_s[2] == pytest.approx(0.0, abs=0.05)


@pytest.mark.parametrize(
    "bad",
    [
        attitude(0.0, -0.3, 0.0, nan),
        attitude(nan, 0.0, 0.0, 0.5),
        attitude(0.0, -0.3, 0.0, 0.5, mask=0x80),
        dialect.MAVLink_set_attitude_target_message(0, 3, 1, 7, [0.0] * 4, 0, 0, 0, 0.5),
    ],
)
def test_a_bad_attitude_moves_nothing(bad: Any) -> None:
    station = flying()
    for _ in range(20):
        station.tick(bad)
    assert place(station) == pytest.approx((0.0, 0.0, -10.0), abs=0.1)


def landed_north(station: GroundStation) -> GroundStation:
    """Down and disarmed, 30 m north of where it was switched on."""
    station.tick(position(30.0, 0.0, -5.0), seconds=15.0)
    station.order(21)
    while station.vehicle.truth.armed:
        station.tick()
    return station


def test_home_is_where_it_was_armed_last() -> None:
    station = landed_north(flying())
    assert station.order(176, 1, GUIDED) == ACCEPTED
    assert station.order(400, 1) == ACCEPTED
    assert station.last("HOME_POSITION").latitude == pytest.approx(north_of_home(30.0)["x"], abs=30)


def test_home_that_was_set_stays() -> None:
    station = flying()
    assert station.order(179, 0, 0, 0, 0, HOME.latitude_deg, HOME.longitude_deg, HOME.altitude_m) == ACCEPTED
    landed_north(station)
    station.order(176, 1, GUIDED)
    assert station.order(400, 1) == ACCEPTED
    assert station.last("HOME_POSITION").latitude == pytest.approx(north_of_home(0.0)["x"], abs=30)


def test_home_moves_and_the_return_leads_there() -> None:
    station = flying()
    station.tick(position(30.0, 0.0, -10.0), seconds=12.0)
    assert station.order(179, 1) == ACCEPTED
    assert station.last("HOME_POSITION").latitude == pytest.approx(north_of_home(30.0)["x"], abs=30)
    station.stream(33)
    station.tick()
    assert station.last("GLOBAL_POSITION_INT").relative_alt == pytest.approx(0, abs=200)
    assert order_int(station, 179, 0, frame=0, z=HOME.altitude_m, **north_of_home(15.0)) == ACCEPTED
    assert station.order(179, 0, 0, 0, 0, nan, 0, 0) == FAILED
    station.order(20)
    while station.vehicle.truth.armed and station.now_s < 120.0:
        station.tick()
    assert place(station) == pytest.approx((15.0, 0.0, 0.0), abs=0.5)


def test_guided_pauses_and_goes_on() -> None:
    station = flying()
    station.tick(position(60.0, 0.0, -10.0), seconds=3.0)
    assert station.order(193, 0) == ACCEPTED
    station.tick(seconds=6.0)
    stopped = place(station)
    station.tick(seconds=3.0)
    assert place(station) == pytest.approx(stopped, abs=0.1)
    assert station.order(193, 1) == ACCEPTED
    station.tick(seconds=15.0)
    assert place(station)[0] == pytest.approx(60.0, abs=0.3)
    assert station.order(193, 5) == DENIED
    station.order(176, 1, LOITER)
    assert station.order(193, 0) == FAILED
    assert station.texts()[-1] == "Failed to pause"


def test_a_mission_pauses_and_goes_on() -> None:
    station = started(TAKEOFF, at(60, 0, 10), Item(17))
    until(station, "Mission: 2 WP")
    station.tick(seconds=2.0)
    assert station.order(193, 0) == ACCEPTED
    station.tick(seconds=8.0)
    assert place(station)[0] < 40.0
    assert station.order(193, 1) == ACCEPTED
    until(station, "Reached command #2")


def test_termination_drops_it() -> None:
    station = flying()
    assert station.order(185, 0) == FAILED  # recorded
    assert station.order(185, 1) == ACCEPTED
    assert not station.vehicle.truth.armed


def test_a_reboot_boots_again_and_keeps_parameters() -> None:
    station = ready()
    station.tick(dialect.MAVLink_param_set_message(3, 1, b"RTL_ALT", 2000.0, 6))
    station.stream(33)
    station.order(400, 1)
    assert station.order(246, 1) == FAILED  # armed
    station.order(400, 0)
    assert station.order(246, 7) == UNSUPPORTED
    said = len(station.texts())
    assert station.order(246, 1) == ACCEPTED
    assert station.last("HEARTBEAT").custom_mode == 0
    assert station.order(400, 1) == FAILED
    heard = station.tick(seconds=3.0)
    assert "GLOBAL_POSITION_INT" not in {message.get_type() for message in heard}
    assert "ArduPilot Ready" in station.texts()[said:]
    assert "EKF3 IMU1 is using GPS" in station.texts()[said:]
    station.order(512, 2)
    assert station.last("SYSTEM_TIME").time_boot_ms < 4000
    station.tick(dialect.MAVLink_param_request_read_message(3, 1, b"RTL_ALT", -1))
    assert station.last("PARAM_VALUE").param_value == 2000.0


def test_capabilities_and_version() -> None:
    station = ready()
    assert station.order(520, 1) == ACCEPTED
    assert station.last("AUTOPILOT_VERSION").capabilities & 0xC005 == 0xC005  # missions, fences, rally points


def test_time_and_ping_come_back() -> None:
    station = ready()
    heard = station.tick(
        dialect.MAVLink_timesync_message(0, 123456789), dialect.MAVLink_ping_message(77, 5, 0, 0)
    )  # fmt: skip
    sync = next(message for message in heard if message.get_type() == "TIMESYNC")
    assert sync.ts1 == 123456789
    assert sync.tc1 == pytest.approx((station.now_s - 0.1) * 1e9, abs=1e6)
    ping = next(message for message in heard if message.get_type() == "PING")
    assert (ping.time_usec, ping.seq, ping.target_system, ping.target_component) == (77, 5, 255, 190)
    answered = station.tick(dialect.MAVLink_timesync_message(1, 2), dialect.MAVLink_ping_message(77, 5, 3, 1))
    assert {message.get_type() for message in answered} <= {"HEARTBEAT"}


@pytest.mark.parametrize(("opcode", "answer", "error"), [(4, 129, 10), (3, 129, 10), (99, 129, 7), (1, 128, None)])
def test_files_are_refused_at_once(opcode: int, answer: int, error: int | None) -> None:
    station = ready()
    name = b"@PARAM/param.pck"
    asked = (7).to_bytes(2, "little") + bytes([2, opcode, len(name), 0, 0, 0]) + bytes(4) + name
    heard = station.tick(dialect.MAVLink_file_transfer_protocol_message(0, 3, 1, list(asked.ljust(251, b"\0"))))
    payload = bytes(next(m for m in heard if m.get_type() == "FILE_TRANSFER_PROTOCOL").payload)
    assert (payload[:2], payload[2], payload[3], payload[5]) == ((8).to_bytes(2, "little"), 2, answer, opcode)
    assert payload[4] == (0 if error is None else 1)
    assert error is None or payload[12] == error


def test_there_is_no_log() -> None:
    station = ready()
    station.tick(dialect.MAVLink_log_request_list_message(3, 1, 0, 0xFFFF))
    assert (station.last("LOG_ENTRY").num_logs, station.last("LOG_ENTRY").size) == (0, 0)


def test_a_velocity_ends_an_attitude() -> None:
    station = flying()
    station.tick(attitude(0.0, -0.2, 0.0, 0.5))
    for _ in range(60):
        station.tick(velocity(0.0, 2.0))
    assert station.vehicle.truth.velocity_ned_m_s == pytest.approx((0.0, 2.0, 0.0), abs=0.1)
