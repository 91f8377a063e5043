"""Commands and their answers, as a recorded ArduCopter 4.5.5 SITL gives them."""

from __future__ import annotations

from math import inf, nan

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import (
    BRAKE,
    GUIDED,
    LAND,
    RTL,
    GroundStation,
    flying,
    order,
    ready,
)  # fmt: skip

ACCEPTED, DENIED, UNSUPPORTED, FAILED = 0, 2, 3, 4

# (state, command, parameters, result, the text behind it)
CASES = [
    ("ready", 31999, (1,), UNSUPPORTED, None),
    ("ready", 31999, (nan,) * 7, UNSUPPORTED, None),
    ("ready", 176, (1, 99), FAILED, "No such mode 99"),
    ("ready", 176, (1, 13), FAILED, "No such mode 13"),
    ("ready", 176, (0, GUIDED), DENIED, None),
    ("ready", 176, (nan, GUIDED), DENIED, None),
    ("ready", 512, (9999,), FAILED, "No ap_message for mavlink id (9999)"),
    ("ready", 511, (9999, 1e5), DENIED, "No ap_message for mavlink id (9999)"),
    ("ready", 511, (32, nan), DENIED, None),
    ("ready", 511, (32, -2), DENIED, None),
    ("ready", 178, (1, 8), ACCEPTED, None),
    ("ready", 178, (1, -3), FAILED, None),
    ("ready", 178, (1, nan), FAILED, None),
    ("ready", 400, (nan,), UNSUPPORTED, None),
    ("ready", 400, (1, nan, nan, nan, nan, nan, nan), ACCEPTED, "Arming motors"),
    ("ready", 22, (0, 0, 0, 0, 0, 0, 10), FAILED, None),  # not armed
    ("ready", 16, (0,), UNSUPPORTED, None),
    ("ready", 410, (), ACCEPTED, None),
    ("ready", 21, (), ACCEPTED, None),
    ("flying", 400, (1,), ACCEPTED, None),
    ("flying", 400, (0,), FAILED, None),  # disarm in the air
    ("flying", 22, (0, 0, 0, 0, 0, 0, 12), FAILED, None),  # a second takeoff
    ("flying", 20, (), ACCEPTED, None),
]


@pytest.mark.parametrize(("state", "command", "params", "result", "text"), CASES)
def test_results_and_texts(state: str, command: int, params: tuple[float, ...], result: int, text: str | None) -> None:
    station = ready() if state == "ready" else flying()
    heard = station.tick(order(command, *params))
    ack = heard[0]  # the acknowledgement goes first, whatever else there is to say
    assert (ack.get_type(), ack.command, ack.result) == ("COMMAND_ACK", command, result)
    assert (ack.target_system, ack.target_component) == (255, 190)
    assert [message.text for message in heard if message.get_type() == "STATUSTEXT"] == ([text] if text else [])


@pytest.mark.parametrize("altitude_m", [-5.0, 0.0, nan, inf, 1e9])
def test_takeoff_to_nowhere_is_refused(altitude_m: float) -> None:
    station = ready()
    station.order(400, 1)
    assert station.order(22, 0, 0, 0, 0, 0, 0, altitude_m) == FAILED
    station.tick(seconds=5.0)
    assert station.vehicle.truth.on_ground


def test_who_is_meant() -> None:
    """Another system: silence. Everybody, or any component of this one: done."""
    station = ready()
    kinds = [message.get_type() for message in station.tick(order(400, 1, system=77))]
    assert "COMMAND_ACK" not in kinds
    assert not station.vehicle.truth.armed
    assert station.tick(order(400, 1, system=0))[0].result == ACCEPTED
    assert station.tick(order(400, 0, component=99))[0].result == ACCEPTED
    assert not station.vehicle.truth.armed


def test_heartbeat_at_once_when_mode_or_arming_changes() -> None:
    station = GroundStation()
    station.tick(seconds=3.4)

    def beats(command: int, *params: float) -> list[tuple[int, int, int]]:
        heard = station.tick(order(command, *params))
        return [(m.base_mode, m.custom_mode, m.system_status) for m in heard if m.get_type() == "HEARTBEAT"]

    assert beats(176, 1, GUIDED) == [(89, 4, 3)]
    assert beats(400, 1) == [(217, 4, 3)]
    assert beats(400, 0) == [(89, 4, 3)]
    assert beats(176, 1, LAND) == [(81, 9, 3)]
    assert beats(176, 1, LAND) == []


def test_old_set_mode_is_acknowledged_as_message_11() -> None:
    station = ready()
    heard = station.tick(dialect.MAVLink_set_mode_message(3, 1, BRAKE))
    assert (heard[0].get_type(), heard[0].command, heard[0].result) == ("COMMAND_ACK", 11, ACCEPTED)
    assert station.vehicle.mode_name == "BRAKE"


def test_command_int_is_the_same_table() -> None:
    station = ready()
    heard = station.tick(dialect.MAVLink_command_int_message(3, 1, 0, 400, 0, 0, 1, 0, 0, 0, 0, 0, 0))
    assert (heard[0].command, heard[0].result) == (400, ACCEPTED)
    assert station.vehicle.truth.armed


@pytest.mark.parametrize("mode", [RTL, LAND, BRAKE])
def test_some_modes_do_not_arm(mode: int) -> None:
    station = ready()
    station.order(176, 1, mode)
    assert station.order(400, 1) == FAILED
    assert station.texts()[-1] == "Arm: Mode not armable"


def test_force_arm_skips_the_checks_and_modes_still_want_a_position() -> None:
    station = GroundStation(seed=1)
    assert station.order(400, 1, 2989) == ACCEPTED
    assert station.order(176, 1, GUIDED) == FAILED
    assert "Mode change to GUIDED failed: requires position" in station.texts()


def test_left_alone_on_the_ground_it_disarms_after_ten_seconds() -> None:
    station = ready()
    station.order(400, 1)
    armed_s = station.now_s - 0.1
    station.tick(seconds=12.0)
    disarmed_s = next(at_s for at_s, text in station.all("STATUSTEXT") if text.text == "Disarming motors")
    assert disarmed_s - armed_s == pytest.approx(10.0, abs=0.11)


def test_forced_disarm_in_the_air_drops_it() -> None:
    station = flying()
    assert station.order(400, 0, 21196) == ACCEPTED
    assert (station.last("HEARTBEAT").base_mode, station.last("HEARTBEAT").system_status) == (89, 3)
    station.tick(seconds=3.0)
    assert station.vehicle.truth.on_ground
    hit = next(text for text in station.texts() if text.startswith("SIM Hit ground at"))
    assert float(hit.split()[4]) == pytest.approx(11.75, abs=0.8)


def test_an_interval_of_zero_is_the_usual_one() -> None:
    station = ready()
    station.tick(dialect.MAVLink_param_set_message(3, 1, b"SR0_EXTRA1", 4.0, 4))
    for asked_us, given_us in ((-1, -1), (0, 250_000), (10, 1_000), (1e9, 60_000_000), (0, 250_000)):
        assert station.order(511, 30, asked_us) == ACCEPTED
        station.order(510, 30)
        assert station.last("MESSAGE_INTERVAL").interval_us == given_us
    assert station.order(511, 148, 0) == FAILED  # AUTOPILOT_VERSION has no usual one


def test_rates_are_asked_for_told_and_taken_back() -> None:
    station = ready()
    assert station.order(511, 30, 200_000) == ACCEPTED
    station.order(510, 30)
    assert station.last("MESSAGE_INTERVAL").interval_us == 200_000
    heard = station.tick(seconds=10.0)
    assert sum(message.get_type() == "ATTITUDE" for message in heard) == 50
    station.order(511, 30, -1)
    station.order(510, 30)
    assert station.last("MESSAGE_INTERVAL").interval_us == -1
    station.order(510, 9999)
    assert station.last("MESSAGE_INTERVAL").interval_us == 0
    assert "ATTITUDE" not in {message.get_type() for message in station.tick(seconds=2.0)}
    station.order(511, 0, 0)  # the heartbeat goes back to its own rate
    assert sum(message.get_type() == "HEARTBEAT" for message in station.tick(seconds=5.0)) == 5


def test_data_streams_are_the_older_way() -> None:
    station = ready()
    station.tick(dialect.MAVLink_request_data_stream_message(3, 1, 0, 4, 1))
    heard = [message.get_type() for message in station.tick(seconds=10.0)]
    assert heard.count("LOCAL_POSITION_NED") == heard.count("SYS_STATUS") == pytest.approx(40, abs=1)
    station.tick(dialect.MAVLink_request_data_stream_message(3, 1, 6, 4, 0))
    heard = [message.get_type() for message in station.tick(seconds=5.0)]
    assert "LOCAL_POSITION_NED" not in heard
    assert "SYS_STATUS" in heard


def test_version_on_request() -> None:
    station = ready()
    assert station.order(512, 148) == ACCEPTED
    version = station.last("AUTOPILOT_VERSION")
    assert version.flight_sw_version == 67438079  # recorded: 4.5.5 official
    assert bytes(version.flight_custom_version) == b"142aece2"
