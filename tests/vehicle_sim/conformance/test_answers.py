"""Commands beside the recorded answers: the result, and the text behind it, in the state it was recorded in."""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import (
    GUIDED,
    SYSTEM,
    GroundStation,
    flying,
    order,
    position,
    ready,
    velocity,
)
from vehicle_sim.vehicle import VehicleConfig

ACCEPTED, DENIED, UNSUPPORTED, FAILED, SILENCE = 0, 2, 3, 4, -1


def young() -> GroundStation:
    """Six seconds after power-on, in STABILIZE."""
    station = GroundStation(VehicleConfig(boot_s=41.16))
    station.tick(seconds=6.0)
    return station


def armed() -> GroundStation:
    station = ready()
    assert station.order(400, 1) == ACCEPTED
    return station


# Recorded in flight_part1, flight2, probe3, probe4 and nan: who is asked, what, the result, the texts behind it.
RECORDED: list[tuple[Callable[[], GroundStation], int, tuple[float, ...], int, tuple[str, ...]]] = [
    (young, 22, (0, 0, 0, 0, 0, 0, 10), FAILED, ()),
    (young, 511, (2, 100_000), ACCEPTED, ()),
    (young, 176, (1, GUIDED), ACCEPTED, ()),
    (young, 176, (1, GUIDED, nan, nan, nan, nan, nan), ACCEPTED, ()),
    (young, 511, (32, 100_000, nan, nan, nan, nan, nan), ACCEPTED, ()),
    (young, 31999, (nan,) * 7, UNSUPPORTED, ()),
    (young, 400, (nan,), UNSUPPORTED, ()),
    (
        young,
        400,
        (1, *(nan,) * 6),
        FAILED,
        ("Arm: Accels inconsistent", "Arm: AHRS: waiting for home"),
    ),
    (young, 178, (1, nan), FAILED, ()),
    (young, 115, (nan,), FAILED, ()),
    (ready, 512, (49,), ACCEPTED, ()),
    (ready, 512, (242,), ACCEPTED, ()),
    (ready, 512, (148,), ACCEPTED, ()),
    (ready, 176, (1, GUIDED), ACCEPTED, ()),
    (ready, 400, (1,), ACCEPTED, ("Arming motors",)),
    (ready, 400, (1, *(nan,) * 6), ACCEPTED, ("Arming motors",)),
    (armed, 22, (0, 0, 0, 0, 0, 0, 10), ACCEPTED, ()),
    (armed, 22, (0, 0, 0, nan, 0, 0, 10), ACCEPTED, ()),
    (armed, 22, (0, 0, 0, nan, nan, nan, 10), ACCEPTED, ()),
    (flying, 31999, (1,), UNSUPPORTED, ()),
    (flying, 400, (1,), ACCEPTED, ()),
    (flying, 400, (0,), FAILED, ()),
    (flying, 400, (0, 21196), ACCEPTED, ("Disarming motors",)),
    (flying, 176, (1, 99), FAILED, ("No such mode 99",)),
    (flying, 176, (1, 13), FAILED, ("No such mode 13",)),
    (flying, 176, (1, 5), ACCEPTED, ()),
    (flying, 176, (1, 9), ACCEPTED, ()),
    (flying, 176, (1, 6), ACCEPTED, ()),
    (flying, 16, (), UNSUPPORTED, ()),
    (flying, 192, (-1, 1, 0, 0, 47.3978, 8.5457, 10), UNSUPPORTED, ()),
    (flying, 178, (1, 8, -1), ACCEPTED, ()),
    (flying, 178, (1, -3, -1), FAILED, ()),
    (flying, 512, (9999,), FAILED, ("No ap_message for mavlink id (9999)",)),
    (flying, 511, (9999, 100_000), DENIED, ("No ap_message for mavlink id (9999)",)),
    (flying, 22, (0, 0, 0, 0, 0, 0, -5), FAILED, ()),
    (flying, 22, (0, 0, 0, 0, 0, 0, 12), FAILED, ()),
    (flying, 115, (90, 30, 1), ACCEPTED, ()),
    (flying, 179, (1,), ACCEPTED, ()),
    (flying, 410, (), ACCEPTED, ()),
    (flying, 185, (), FAILED, ()),
]

# What is answered differently on purpose: state, command, parameters, the recorded result, ours, and why.
DIFFERENT: list[tuple[Callable[[], GroundStation], int, tuple[float, ...], int, int, str]] = [
    (young, 176, (1, nan), ACCEPTED, FAILED, "NaN is no mode; a real one takes it as 0 or aborts"),
    (young, 511, (nan, 100_000), ACCEPTED, DENIED, "NaN is no message id; a real one takes it as 0 or aborts"),
    (young, 512, (1e20,), ACCEPTED, FAILED, "no message has this id; a real one takes what the cast leaves, or aborts"),
    (armed, 22, (0, 0, 0, 0, 0, 0, nan), ACCEPTED, FAILED, "a real one climbs without end, or aborts"),
]


def result_of(heard: list[Any], command: int) -> int:
    return next((m.result for m in heard if m.get_type() == "COMMAND_ACK" and m.command == command), SILENCE)


@pytest.mark.parametrize(("state", "command", "params", "result", "texts"), RECORDED)
def test_the_answer_is_the_recorded_one(
    state: Callable[[], GroundStation], command: int, params: tuple[float, ...], result: int, texts: tuple[str, ...]
) -> None:
    heard = state().tick(order(command, *params))
    assert result_of(heard, command) == result
    assert tuple(message.text for message in heard if message.get_type() == "STATUSTEXT") == texts


@pytest.mark.parametrize(("state", "command", "params", "theirs", "ours", "why"), DIFFERENT)
def test_a_known_difference_is_still_one(
    state: Callable[[], GroundStation],
    command: int,
    params: tuple[float, ...],
    theirs: int,
    ours: int,
    why: str,
) -> None:
    assert ours != theirs, why
    assert result_of(state().tick(order(command, *params)), command) == ours, why


@pytest.mark.parametrize(
    ("ids", "result"), [({"system": 77}, SILENCE), ({"component": 99}, ACCEPTED), ({"system": 0}, ACCEPTED)]
)
def test_who_is_meant(ids: dict[str, int], result: int) -> None:
    assert result_of(flying().tick(order(400, 1, **ids)), 400) == result


def test_the_old_set_mode_is_acknowledged_as_command_11() -> None:
    assert result_of(flying().tick(dialect.MAVLink_set_mode_message(SYSTEM, 1, 9)), 11) == ACCEPTED


def test_setpoints_before_the_takeoff_and_in_loiter_do_nothing() -> None:
    station = armed()
    for _ in range(20):
        station.tick(velocity(0.0, 0.0, -1.0))
    assert station.vehicle.truth.on_ground
    station = flying()
    station.order(176, 1, 5)
    for _ in range(15):
        station.tick(position(50.0, 0.0, -10.0))
    assert abs(station.vehicle.truth.velocity_ned_m_s[0]) < 0.05


def test_loiter_sinks_without_a_pilot() -> None:
    """Recorded: from 9.9 m to 8.29 m in its first 1.5 s."""
    station = flying()
    station.order(176, 1, 5)
    station.tick(seconds=1.4)
    assert -station.vehicle.truth.position_ned_m[2] == pytest.approx(8.29, abs=1.0)


# probe3: name and stored value.
DEFAULTS = {
    "FS_GCS_ENABLE": 0, "FS_GCS_TIMEOUT": 5, "GUID_TIMEOUT": 3, "GUID_OPTIONS": 0, "WPNAV_SPEED": 1000,
    "WPNAV_SPEED_UP": 250, "WPNAV_SPEED_DN": 150, "WPNAV_ACCEL": 250, "DISARM_DELAY": 10, "ARMING_CHECK": 1,
    "SYSID_MYGCS": 255, "FS_EKF_ACTION": 1, "FS_THR_ENABLE": 1, "FENCE_ENABLE": 0, "ANGLE_MAX": 3000,
    "BATT_LOW_VOLT": 10.5, "RTL_ALT": 1500, "SIM_WIND_SPD": 0,
}  # fmt: skip


@pytest.mark.parametrize("name", DEFAULTS)
def test_a_parameter_has_the_recorded_default(name: str) -> None:
    heard = ready().tick(dialect.MAVLink_param_request_read_message(SYSTEM, 1, name.encode(), -1))
    values = [message.param_value for message in heard if message.get_type() == "PARAM_VALUE"]
    assert values == [pytest.approx(DEFAULTS[name])]


def test_four_vehicles_have_four_frames_and_fly_alike() -> None:
    """swarm4: each reads 0, 0 at its own place; 2 m/s north for 6 s and then a stop bring all to 12.05 to 12.08 m."""
    stations = [flying(seed=seed) for seed in range(4)]
    for station in stations:
        assert station.vehicle.truth.position_ned_m[:2] == (0.0, 0.0)
        for _ in range(60):
            station.tick(velocity(2.0))
        station.tick(velocity(0.0), seconds=2.0)
    norths = [station.vehicle.truth.position_ned_m[0] for station in stations]
    assert norths == [pytest.approx(12.07, abs=0.3)] * 4
    assert max(norths) - min(norths) < 0.035


@pytest.mark.parametrize(("message_id", "name", "period_us", "rate_hz"), [
    (32, "LOCAL_POSITION_NED", 100_000, 10), (30, "ATTITUDE", 100_000, 10), (193, "EKF_STATUS_REPORT", 200_000, 5),
    (1, "SYS_STATUS", 200_000, 5), (245, "EXTENDED_SYS_STATE", 500_000, 2), (24, "GPS_RAW_INT", 200_000, 5),
])  # fmt: skip
def test_a_stream_has_the_rate_that_was_asked_for(message_id: int, name: str, period_us: int, rate_hz: int) -> None:
    """flight_part1: 1529 ATTITUDE in 153 s of 10 Hz, 764 GPS_RAW_INT of 5 Hz, 305 EXTENDED_SYS_STATE of 2 Hz."""
    station = ready()
    station.order(511, message_id, period_us)
    heard = station.tick(seconds=10.0)
    assert sum(message.get_type() == name for message in heard) == pytest.approx(10 * rate_hz, abs=1)
