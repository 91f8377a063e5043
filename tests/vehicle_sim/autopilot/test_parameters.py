"""Parameters: read, listed, set; answered with what is stored; and they act."""

from __future__ import annotations

from math import inf, nan
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

import vehicle_sim
from tests.vehicle_sim.autopilot.ground_station import GroundStation, flying, ready, velocity
from vehicle_sim.autopilot.ardupilot.parameters import ALIASES, INDEX, TABLE
from vehicle_sim.autopilot.parameters import HOLDS
from vehicle_sim.battery import Battery
from vehicle_sim.flight import FlightLimits
from vehicle_sim.vehicle import VehicleConfig
from vehicle_sim.wind import Wind

ROOM = Path(vehicle_sim.__file__).parent

# As recorded from a fresh ArduCopter 4.5.5 SITL: default and MAV_PARAM_TYPE-independent.
RECORDED = {
    "ANGLE_MAX": 3000.0, "DISARM_DELAY": 10.0, "FS_GCS_ENABLE": 0.0, "FS_GCS_TIMEOUT": 5.0, "GUID_TIMEOUT": 3.0,
    "RTL_ALT": 1500.0, "SYSID_MYGCS": 255.0, "WPNAV_ACCEL": 250.0, "WPNAV_SPEED": 1000.0, "WPNAV_SPEED_DN": 150.0,
    "WPNAV_SPEED_UP": 250.0,
}  # fmt: skip


def set_param(station: GroundStation, name: bytes, value: float) -> float:
    heard = station.tick(dialect.MAVLink_param_set_message(3, 1, name, value, 9))
    return float(next(m.param_value for m in heard if m.get_type() == "PARAM_VALUE"))


def test_the_list_is_complete_sorted_and_has_the_recorded_defaults() -> None:
    station = ready()
    heard = station.tick(dialect.MAVLink_param_request_list_message(3, 1))
    values = [message for message in heard if message.get_type() == "PARAM_VALUE"]
    assert [message.param_index for message in values] == list(range(len(TABLE)))
    assert {message.param_count for message in values} == {len(TABLE)}
    names = [message.param_id for message in values]
    assert names == sorted(names)
    defaults = {message.param_id: message.param_value for message in values}
    assert {name: defaults[name] for name in RECORDED} == RECORDED
    assert defaults["SYSID_THISMAV"] == 3.0


def test_limits_battery_and_wind_are_the_missions() -> None:
    config = VehicleConfig(limits=FlightLimits(speed_m_s=7.0), battery=Battery(capacity_mah=4200.0))
    parameters = ready(config).vehicle.autopilot.parameters
    assert (parameters["WPNAV_SPEED"], parameters["BATT_CAPACITY"]) == (700.0, 4200.0)
    station = ready(VehicleConfig(wind=Wind(speed_m_s=3.0, from_deg=1e300), battery=Battery(voltage_v=25.2)))
    heard = station.tick(dialect.MAVLink_param_request_list_message(3, 1))
    values = {message.param_id: message.param_value for message in heard if message.get_type() == "PARAM_VALUE"}
    assert (values["SIM_WIND_SPD"], values["BATT_LOW_VOLT"]) == (3.0, 21.0)
    assert 0.0 <= values["SIM_WIND_DIR"] < 360.0


@pytest.mark.parametrize(
    ("name", "value", "stored"),
    [
        (b"RTL_ALT", 2200.0, 2200.0),
        (b"RTL_ALT", 2200.9, 2200.0),  # an int32: cut
        (b"DISARM_DELAY", 1e9, 127.0),  # an int8
        (b"RTL_ALT", 2200.995, 2201.0),  # cut after .01 is added
        (b"BARO_PRIMARY", -1.5, -1.0),
        (b"BARO_PRIMARY", -1e9, -128.0),
        (b"GUID_TIMEOUT", 1.5, 1.5),
        (b"SYSID_THISMAV", 9.0, 3.0),  # read-only
    ],
)
def test_a_set_is_answered_with_what_is_stored(name: bytes, value: float, stored: float) -> None:
    station = ready()
    assert set_param(station, name, value) == stored
    heard = station.tick(dialect.MAVLink_param_request_read_message(3, 1, name, -1))
    assert heard[0].param_value == stored


def test_what_cannot_be_answered_is_an_error_and_nothing_else() -> None:
    station = ready()
    heard = station.tick(
        dialect.MAVLink_param_set_message(3, 1, b"NO_SUCH_NAME", 1.0, 9),
        dialect.MAVLink_param_request_read_message(3, 1, b"NO_SUCH_NAME", -1),
        dialect.MAVLink_param_request_read_message(3, 1, b"", 999),
        dialect.MAVLink_param_set_message(3, 1, b"WPNAV_SPEED", nan, 9),
        dialect.MAVLink_param_set_message(3, 1, b"WPNAV_SPEED", inf, 9),
    )
    errors = [message for message in heard if message.get_type() == "PARAM_ERROR"]
    assert [(error.error, error.param_index) for error in errors] == [(1, -1), (1, -1), (1, 999), (2, -1), (2, -1)]
    assert not [message for message in heard if message.get_type() == "PARAM_VALUE"]
    assert station.vehicle.autopilot.parameters["WPNAV_SPEED"] == 1000.0


def test_a_read_only_one_says_so() -> None:
    station = ready()
    set_param(station, b"SYSID_THISMAV", 9.0)
    assert station.texts()[-1] == "Param write denied (SYSID_THISMAV)"


@pytest.mark.parametrize(
    ("name", "value", "ours", "stored"),
    [
        (b"MAV_GCS_SYSID", 250.0, "SYSID_MYGCS", 250.0),
        (b"RTL_ALT_M", 22.5, "RTL_ALT", 2250.0),
        (b"WP_SPD", 7.5, "WPNAV_SPEED", 750.0),
        (b"SIM_GPS1_ENABLE", 0.0, "SIM_GPS_DISABLE", 1.0),
    ],
)
def test_names_of_4_7_are_the_same_parameters(name: bytes, value: float, ours: str, stored: float) -> None:
    station = ready()
    assert set_param(station, name, value) == pytest.approx(value)
    assert station.vehicle.autopilot.parameters[ours] == pytest.approx(stored)
    heard = station.tick(dialect.MAVLink_param_request_read_message(3, 1, name, -1))
    assert (heard[0].param_id, heard[0].param_value) == (name.decode(), pytest.approx(value))


def test_the_table_is_in_order() -> None:
    assert {alias.name for alias in ALIASES.values()} <= set(INDEX)
    assert not set(ALIASES) & set(INDEX)
    assert all(len(name) <= 16 for name in (*INDEX, *ALIASES))
    for row in TABLE:
        lowest, highest = HOLDS[row.type]
        assert lowest <= row.default <= highest, row.name
        assert row.lowest is None or row.lowest <= row.default, row.name
        assert row.highest is None or row.default <= row.highest, row.name
        assert row.doc, row.name
        assert row.status in ("acts", "stored", "read-only"), row.name


def test_what_acts_is_read_somewhere() -> None:
    """A row that says `acts` is named in the source of the autopilot or the world it flies in."""
    source = "".join(path.read_text(encoding="utf-8") for path in ROOM.rglob("*.py"))
    assert [row.name for row in TABLE if row.status == "acts" and f'"{row.name}"' not in source] == []


def test_speed_and_timeout_act() -> None:
    station = flying(VehicleConfig(kind="ideal"))
    set_param(station, b"WPNAV_SPEED", 400.0)
    set_param(station, b"GUID_TIMEOUT", 1.0)
    station.tick(velocity(9.0))
    assert station.vehicle.truth.velocity_ned_m_s[0] == pytest.approx(4.0)
    station.tick(seconds=0.9)
    assert station.vehicle.truth.velocity_ned_m_s[0] == pytest.approx(4.0)
    station.tick()
    assert station.vehicle.truth.velocity_ned_m_s[0] == 0.0


def test_disarm_delay_acts_and_zero_is_never() -> None:
    station = ready()
    set_param(station, b"DISARM_DELAY", 0.0)
    station.order(400, 1)
    station.tick(seconds=30.0)
    assert station.vehicle.truth.armed
    set_param(station, b"DISARM_DELAY", 3.0)
    station.tick()
    assert not station.vehicle.truth.armed
