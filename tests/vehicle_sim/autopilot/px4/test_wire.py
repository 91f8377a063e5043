"""Parameters, plans, streams and addresses as PX4 has them on the wire."""

from __future__ import annotations

import struct
from collections import Counter
from itertools import pairwise
from math import isnan, nan
from pathlib import Path
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

import vehicle_sim
from tests.vehicle_sim.autopilot.ground_station import HOME, SYSTEM, order
from tests.vehicle_sim.autopilot.px4.station import (
    ACCEPTED,
    DENIED,
    FAILED,
    INTEGER,
    REAL,
    UNSUPPORTED,
    Px4Station,
    flying,
    ready,
)
from vehicle_sim.autopilot.parameters import REAL32
from vehicle_sim.autopilot.px4.modes import Mode
from vehicle_sim.autopilot.px4.parameters import GIVEN, ROWS, SHARED
from vehicle_sim.autopilot.px4.streams import RATES_HZ
from vehicle_sim.autopilot.px4.telemetry import BUILDERS

WAYPOINT, TAKEOFF, RTL, LAND, SPEED, TURNS = 16, 22, 20, 21, 178, 18


def values(heard: list[Any]) -> list[Any]:
    return [message for message in heard if message.get_type() == "PARAM_VALUE"]


def integer(field: float) -> int:
    return int(struct.unpack("<i", struct.pack("<f", field))[0])


def test_a_hash_comes_first_then_every_parameter() -> None:
    station = ready()
    first, *rest = values(station.tick(dialect.MAVLink_param_request_list_message(SYSTEM, 1)))
    assert (first.param_id, first.param_index, first.param_count) == ("_HASH_CHECK", 65535, len(ROWS))
    assert [message.param_id for message in rest] == [row.name for row in ROWS]
    again = values(station.tick(dialect.MAVLink_param_request_read_message(SYSTEM, 1, b"_HASH_CHECK", -1)))[0]
    assert struct.pack("<f", again.param_value) == struct.pack("<f", first.param_value)
    station.set("RTL_RETURN_ALT", 31.0)
    other = values(station.tick(dialect.MAVLink_param_request_read_message(SYSTEM, 1, b"_HASH_CHECK", -1)))[0]
    assert struct.pack("<f", other.param_value) != struct.pack("<f", first.param_value)


@pytest.mark.parametrize("value", [0, 1, 2, 4001, -1, 2**24 + 1])
def test_integers_travel_as_their_bytes(value: int) -> None:
    station = ready()
    answer = values(station.set("SYS_AUTOSTART", value, INTEGER))[0]
    assert (answer.param_type, integer(answer.param_value)) == (INTEGER, value)
    assert station.pilot.parameters["SYS_AUTOSTART"] == value


@pytest.mark.parametrize(
    ("name", "value", "kind", "error"),
    [("NO_SUCH", 1.0, REAL, 1), ("RTL_RETURN_ALT", nan, REAL, 2), ("MAV_SYS_ID", 7, INTEGER, 3)],
)
def test_what_cannot_be_set_is_an_error(name: str, value: float, kind: int, error: int) -> None:
    station = ready()
    heard = station.set(name, value, kind)
    assert [m.error for m in heard if m.get_type() == "PARAM_ERROR"] == [error]
    assert values(heard) == []


def test_the_table_is_in_order_and_says_what_acts() -> None:
    names = [row.name for row in ROWS]
    assert names == sorted(set(names))
    assert all(len(name) <= 16 for name in names)
    source = "".join(path.read_text() for path in Path(vehicle_sim.__file__).parent.rglob("*.py"))
    assert [row.name for row in ROWS if row.status == "acts" and f'"{row.name}"' not in source] == []
    assert [row.name for row in ROWS if not (row.lowest or -1e9) <= row.default <= (row.highest or 1e9)] == []


def test_what_it_shares_is_the_same_quantity() -> None:
    station = ready()
    for name, alias in SHARED.items():
        row = next(row for row in ROWS if row.name == alias.name)
        station.set(row.name, 3.0, REAL if row.type == REAL32 else INTEGER)
        assert station.pilot.parameters[name] == pytest.approx(alias.scale * 3.0 + alias.offset), name
    assert not SHARED.keys() & {"AUTO_OPTIONS", "MIS_RESTART"}
    assert {name for name in SHARED if name.startswith("SIM_")} <= GIVEN.keys()


# Plans.


def item(seq: int, command: int, *, kind: int = 0, north_m: float = 0.0, z: float = 10.0, p4: float = nan) -> Any:
    x, y = round((HOME.latitude_deg + north_m / 111_319.49) * 1e7), round(HOME.longitude_deg * 1e7)
    place = (x, y) if command not in (RTL, SPEED) else (0, 0)
    params = (1.0, 4.0, -1.0, nan) if command == SPEED else (0.0, 0.0, 0.0, p4)
    return dialect.MAVLink_mission_item_int_message(SYSTEM, 1, seq, 6, command, 0, 1, *params, *place, z, kind)


def upload(station: Px4Station, *commands: int, north_m: float = 20.0) -> None:
    station.tick(dialect.MAVLink_mission_count_message(SYSTEM, 1, len(commands)))
    for seq, command in enumerate(commands):
        station.tick(item(seq, command, north_m=0.0 if command == TAKEOFF else north_m))
    assert station.last("MISSION_ACK").type == 0


def test_an_upload_asks_with_integers_again_after_a_quarter_and_gives_up_after_five_seconds() -> None:
    station = ready()
    station.tick(dialect.MAVLink_mission_count_message(SYSTEM, 1, 2))
    station.tick(item(0, TAKEOFF))
    asked_from_s = station.now_s
    station.tick(seconds=8.0)
    asked = [at_s for at_s, message in station.all("MISSION_REQUEST_INT") if message.seq == 1]
    assert all(0.2 < later - at_s < 0.4 for at_s, later in pairwise(asked))
    assert asked[-1] - asked_from_s == pytest.approx(5.0, abs=0.3)
    assert len(asked) > 12
    assert not station.pilot.mission.items


def test_an_item_out_of_order_is_passed_by() -> None:
    station = ready()
    station.tick(dialect.MAVLink_mission_count_message(SYSTEM, 1, 2))
    station.tick(item(1, WAYPOINT))
    station.tick(item(0, TAKEOFF))
    station.tick(item(1, WAYPOINT))
    assert [message.type for _, message in station.all("MISSION_ACK")] == [0]
    assert [i.command for i in station.pilot.mission.items] == [TAKEOFF, WAYPOINT]


def test_item_0_is_a_real_one_and_nan_comes_back_as_nan() -> None:
    station = ready()
    upload(station, TAKEOFF, SPEED, WAYPOINT)
    heard = station.tick(*(dialect.MAVLink_mission_request_int_message(SYSTEM, 1, seq) for seq in range(3)))
    items = [message for message in heard if message.get_type() == "MISSION_ITEM_INT"]
    assert [message.command for message in items] == [TAKEOFF, SPEED, WAYPOINT]
    assert isnan(items[1].param4)


def test_what_px4_has_not_is_refused() -> None:
    station = ready()
    station.tick(dialect.MAVLink_mission_count_message(SYSTEM, 1, 1))
    station.tick(item(0, TURNS))
    assert station.last("MISSION_ACK").type == 3


@pytest.mark.parametrize("commands", [(TAKEOFF, WAYPOINT, SPEED, WAYPOINT, RTL), (WAYPOINT, LAND)])
def test_mission_start_arms_lifts_off_flies_and_comes_down(commands: tuple[int, ...]) -> None:
    station = ready()
    upload(station, *commands)
    assert station.order(300) == ACCEPTED
    assert (station.mode, station.pilot.armed) == (Mode.MISSION, True)
    farthest_m, heard = 0.0, 0
    while station.pilot.armed and station.now_s < 200.0:
        station.tick(seconds=1.0)
        farthest_m = max(farthest_m, station.vehicle.truth.position_ned_m[0])
        heard = max(heard, station.last("MISSION_CURRENT").seq)
    assert farthest_m == pytest.approx(20.0, abs=1.5)
    assert heard == len(commands) - 1
    reached = [message.seq for _, message in station.all("MISSION_ITEM_REACHED")]
    assert reached[0] == 0
    assert "Disarmed by landing" in station.texts()
    assert station.mode is Mode.MISSION
    assert station.order(400, 1) == ACCEPTED  # it would fly it again


def test_without_a_mission_there_is_nothing_to_start() -> None:
    station = ready()
    assert station.order(300) == DENIED
    assert station.texts()[-1] == "Mission start denied! No valid mission"
    upload(station, TAKEOFF)
    assert station.order(300, 7) == DENIED
    assert station.order(300, nan) == DENIED


# Streams and addresses.


def test_streams_flow_unasked_at_the_rates_of_the_table() -> None:
    station = flying()
    station.log.clear()
    station.tick(seconds=40.0)
    counts = Counter(message.get_msgId() for _, message in station.log)
    for number, rate_hz in RATES_HZ.items():
        if rate_hz <= 10.0:  # a tick of the test is a tenth of a second
            assert abs(counts[number] - 40.0 * rate_hz) <= 2.0, BUILDERS[number]
    assert counts[30] == pytest.approx(400, abs=2)
    assert counts[105] == 0


def test_data_streams_are_unknown() -> None:
    station = ready()
    before = dict(station.vehicle.channels[0].streams._periods_s)
    station.tick(dialect.MAVLink_request_data_stream_message(SYSTEM, 1, 0, 50, 1))
    assert station.vehicle.channels[0].streams._periods_s == before


def test_an_interval_is_set_reset_switched_off_and_refused() -> None:
    station = ready()

    def interval(number: int) -> int:
        station.order(510, number)
        return int(station.last("MESSAGE_INTERVAL").interval_us)

    assert interval(30) == 66_667
    assert station.order(511, 30, 200_000) == ACCEPTED
    assert interval(30) == 200_000
    assert station.order(511, 30, -1) == ACCEPTED
    assert interval(30) == -1
    assert station.order(511, 30, 0) == ACCEPTED
    assert interval(30) == 66_667
    assert station.order(511, 12_345, 1000) == FAILED
    assert station.order(511, 30, nan) == FAILED


@pytest.mark.parametrize("number", sorted(BUILDERS))
def test_every_message_can_be_asked_for(number: int) -> None:
    station = flying()
    heard = station.tick(order(512, number))
    assert [m.result for m in heard if m.get_type() == "COMMAND_ACK"] == [ACCEPTED]
    assert number in {message.get_msgId() for message in heard}


@pytest.mark.parametrize(
    ("command", "system", "component", "heard"),
    [
        (410, SYSTEM, 1, True),
        (410, SYSTEM, 0, True),
        (410, SYSTEM, 154, False),  # a gimbal's
        (410, 0, 1, False),
        (512, 0, 0, True),
        (512, SYSTEM, 154, True),
        (410, 9, 1, False),
    ],
)
def test_who_a_command_is_for(command: int, system: int, component: int, heard: bool) -> None:
    station = ready()
    answers = station.tick(order(command, 242, system=system, component=component))
    assert any(message.get_type() == "COMMAND_ACK" for message in answers) is heard


@pytest.mark.parametrize("command", [181, 207, 115, 193, 31_000, 65_535])
def test_other_commands_are_unsupported(command: int) -> None:
    assert ready().order(command) == UNSUPPORTED


def test_the_version_says_px4_and_bytewise_parameters() -> None:
    station = ready()
    assert station.order(520, 1) == ACCEPTED
    version = station.last("AUTOPILOT_VERSION")
    assert version.flight_sw_version >> 16 == 0x010F
    assert version.capabilities & 16
    assert not version.capabilities & 2


def test_a_reboot_forgets_rates_and_boots_again_and_only_on_the_ground() -> None:
    station = ready()
    assert station.order(511, 30, 500_000) == ACCEPTED
    assert station.order(246, 1) == ACCEPTED
    assert station.order(400, 1) == 1
    station.tick(seconds=3.0)
    assert station.texts().count("Ready for takeoff!") == 2
    station.order(510, 30)
    assert station.last("MESSAGE_INTERVAL").interval_us == 66_667
    assert flying().order(246, 1) == DENIED
