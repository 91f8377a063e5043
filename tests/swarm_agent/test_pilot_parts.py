"""The pilot's parts on their own: what the vehicle says, what it is asked, and the limits on what leaves."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, inf, isfinite, nan
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint
from comms.mavlink import Endpoint, Message
from comms.status import Event, Level
from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.errand import Errand, Progress
from swarm_agent.autopilot.flavors import ARDUPILOT, AltitudeParameter
from swarm_agent.autopilot.ground import Takeoff
from swarm_agent.autopilot.requests import Answer, Command, WriteAltitude, arm, set_mode, stream
from swarm_agent.autopilot.setpoint import hold_layer, limit_speed, velocity_setpoint
from swarm_agent.autopilot.telemetry import Telemetry
from swarm_agent.autopilot.texts import TextAssembler
from swarm_agent.autopilot.transaction import Outcome, Transaction
from tests.swarm_agent.pilot_flight import config
from tests.swarm_agent.scripted_copter import HOME

# Frames of a recorded ArduCopter 4.5.5 SITL in flight.
RECORDED_ORIGIN = "fd1000000501013100004c52401c44f41705a4720700161505037ad1"
RECORDED_POSITION = "fd1c0000ee010120000057ed00008f7f154156fbacbc91a81dc12e477b3f8b35bb3cc163f6bb6dc9"
RECORDED_ATTITUDE = "fd1c0000e601011e0000f3ec00009c1b753bbb4cd1bcc9ec2d390015743adf5763bb95dca4ba8a79"
RECORDED_GLOBAL = "fd170000e70101210000f3ec00008a55401c41f417051e990700a5260000620002f143"
RECORDED_STATUS = "fd1f0000e801010100002ffc71532ffc61532ffc715700003831fa0a0000000000000000000000006072cf"
RECORDED_ARM_TEXT = "fd1900000f0101fd00000241726d3a20416363656c7320696e636f6e73697374656e747515"


def decoded(frame: str) -> Message:
    (message,) = Endpoint(system_id=255).receive(bytes.fromhex(frame))
    return message


def heard(*frames: str) -> Telemetry:
    telemetry = Telemetry(HOME)
    for frame in frames:
        telemetry.hear(decoded(frame), 1.0)
    return telemetry


def position(x: float, vx: float = 0.0, boot_ms: int = 1000) -> Message:
    return dialect.MAVLink_local_position_ned_message(boot_ms, x, 0.0, 0.0, vx, 0.0, 0.0)


class TestTelemetry:
    def test_a_recorded_flight_in_the_missions_frame(self) -> None:
        # The vehicle booted at the mission's home; LOCAL_POSITION_NED x 9.3437, y -0.0211, z -9.8537, vx 0.9816.
        telemetry = heard(RECORDED_ORIGIN, RECORDED_POSITION, RECORDED_GLOBAL, RECORDED_ATTITUDE, RECORDED_STATUS)
        assert telemetry.position_m == pytest.approx((-0.0211, 9.3437, 9.8537), abs=1e-3)
        assert telemetry.velocity_m_s == pytest.approx((0.0229, 0.9816, 0.0075), abs=1e-3)
        assert telemetry.heading_rad == pytest.approx(0.000166, abs=1e-6)
        assert telemetry.battery == 0.96
        assert telemetry.prearm_ok
        assert telemetry.frames_agree
        assert telemetry.ignored == 0

    def test_no_position_without_an_origin(self) -> None:
        telemetry = heard(RECORDED_POSITION)
        assert telemetry.position_m is None
        telemetry.hear(decoded(RECORDED_ORIGIN), 1.0)
        assert telemetry.position_m is not None

    @pytest.mark.parametrize("x", [nan, inf, -inf, 2e6])
    def test_absurd_positions_are_ignored_and_counted(self, x: float) -> None:
        telemetry = heard(RECORDED_ORIGIN, RECORDED_POSITION)
        before = telemetry.position_m
        telemetry.hear(position(x), 2.0)
        telemetry.hear(position(0.0, vx=x), 2.0)
        assert telemetry.position_m == before
        assert telemetry.position_at_s == 1.0
        assert telemetry.ignored == 2

    def test_an_origin_at_zero_zero_is_none(self) -> None:
        telemetry = Telemetry(HOME)
        telemetry.hear(dialect.MAVLink_gps_global_origin_message(0, 0, 0, 0), 1.0)
        assert telemetry.origin_m is None
        assert telemetry.ignored == 1

    def test_frames_that_disagree_are_noticed(self) -> None:
        telemetry = heard(RECORDED_ORIGIN, RECORDED_GLOBAL)
        telemetry.hear(position(35.0), 1.0)  # GLOBAL_POSITION_INT is 9.2 m north
        assert not telemetry.frames_agree

    def test_a_boot_clock_that_falls_back_forgets(self) -> None:
        telemetry = heard(RECORDED_ORIGIN, RECORDED_POSITION)
        telemetry.hear(position(1.0, boot_ms=500), 2.0)
        assert telemetry.restarts == 1
        assert telemetry.position_m is None

    def test_landed_is_known_from_the_heartbeat_alone(self) -> None:
        telemetry = Telemetry(HOME)
        assert telemetry.landed is None
        for base_mode, status, landed in [(81, 3, True), (217, 3, True), (217, 4, False), (217, 5, False)]:
            telemetry.hear(dialect.MAVLink_heartbeat_message(2, 3, base_mode, 4, status, 3), 1.0)
            assert telemetry.landed is landed


class TestTexts:
    def test_recorded_text(self) -> None:
        assert TextAssembler().hear(decoded(RECORDED_ARM_TEXT)) == Event(
            Level.WARNING, "Arm: Accels inconsistent"
        )  # it is asked again

    def test_chunks_are_joined(self) -> None:
        texts, long = TextAssembler(), "x" * 50
        assert texts.hear(sent(dialect.MAVLink_statustext_message(4, long.encode(), 7, 0))) is None
        assert texts.hear(sent(dialect.MAVLink_statustext_message(4, b"end", 7, 1))) == Event(
            Level.WARNING, long + "end"
        )

    def test_a_text_cut_off_does_not_run_into_the_next(self) -> None:
        texts = TextAssembler()
        texts.hear(sent(dialect.MAVLink_statustext_message(4, b"y" * 50, 7, 0)))
        assert texts.hear(sent(dialect.MAVLink_statustext_message(6, b"new", 8, 0))) == Event(Level.INFO, "new")

    def test_what_is_no_text_is_silence(self) -> None:
        assert TextAssembler().hear(sent(dialect.MAVLink_statustext_message(2, b"\x1b\x07", 0, 0))) is None


def sent(message: Message) -> Message:
    """The message as it arrives."""
    end = Endpoint(system_id=4)
    end.send(message)
    (received,) = Endpoint(system_id=255).receive(end.take())
    return received


speeds = st.floats(allow_nan=True, allow_infinity=True)


class TestSetpoint:
    @given(east=speeds, north=speeds)
    def test_never_faster_never_no_number(self, east: float, north: float) -> None:
        limited = limit_speed((east, north), max_speed_m_s=5.0)
        if limited is None:
            assert not isfinite(hypot(east, north))
        else:
            assert hypot(*limited) <= 5.0 * (1.0 + 1e-9)
            assert hypot(east, north) > 5.0 or limited == (east, north)

    @given(east=st.floats(-1e6, 1e6), north=st.floats(-1e6, 1e6))
    def test_the_direction_stays(self, east: float, north: float) -> None:
        limited = limit_speed((east, north), max_speed_m_s=5.0)
        assert limited is not None
        assert limited[0] * north == pytest.approx(limited[1] * east, rel=1e-9, abs=1e-9)

    @pytest.mark.parametrize(("up_m", "climb_m_s"), [(16.0, 0.0), (15.0, 0.5), (17.0, -0.5), (0.0, 1.5), (90.0, -1.5)])
    def test_holds_the_layer(self, up_m: float, climb_m_s: float) -> None:
        assert hold_layer(up_m, layer_m=16.0, max_climb_m_s=1.5) == climb_m_s

    def test_on_the_wire(self) -> None:
        message = sent(velocity_setpoint((1.0, 2.0, 0.5), system_id=4, now_s=1e9))
        assert (message.vx, message.vy, message.vz) == (2.0, 1.0, -0.5)
        assert (message.type_mask, message.coordinate_frame, message.target_system) == (0xDC7, 1, 4)


class TestRequests:
    @pytest.mark.parametrize("value", [nan, inf, -inf, 1e9])
    def test_no_command_holds_an_absurd_number(self, value: float) -> None:
        with pytest.raises(ValueError, match="takeoff"):
            Command("takeoff", 22, (value,))

    @pytest.mark.parametrize(
        ("result", "answer"),
        [(0, Answer.ACCEPTED), (1, Answer.REFUSED), (2, Answer.REFUSED), (3, Answer.UNSUPPORTED),
         (4, Answer.REFUSED), (5, Answer.IN_PROGRESS), (250, Answer.REFUSED)],
    )  # fmt: skip
    def test_results(self, result: int, answer: Answer) -> None:
        assert arm().answer_in(dialect.MAVLink_command_ack_message(400, result)) is answer
        assert arm().answer_in(dialect.MAVLink_command_ack_message(22, result)) is None

    def test_mode_and_rate_as_the_recordings_have_them(self) -> None:
        mode, rate = set_mode(ARDUPILOT.guided), stream(32, 10)
        assert (mode.command, mode.parameters[:2]) == (176, (1.0, 4.0))
        assert (rate.command, rate.parameters) == (511, (32.0, 1e5))

    @pytest.mark.parametrize(("parameter", "value"), list(zip(ARDUPILOT.return_altitude, (1650.0, 16.5), strict=True)))
    def test_return_altitude_in_either_unit(self, parameter: AltitudeParameter, value: float) -> None:
        request = WriteAltitude(parameter, 16.5)
        message = request.message(system_id=4, repeat=0)
        assert message.param_value == value
        name = parameter.name.encode()
        answers = {v: request.answer_in(sent(dialect.MAVLink_param_value_message(name, v, 6, 1, 0)))
                   for v in (value, value + 1.0, nan)}  # fmt: skip
        assert list(answers.values())[1:] == [
            Answer.ACCEPTED if parameter.units_per_m > 100.0 else Answer.REFUSED,
            Answer.REFUSED,
        ]
        assert answers[value] is Answer.ACCEPTED
        other = dialect.MAVLink_param_value_message(b"RTL_SPEED", value, 6, 1, 0)
        assert request.answer_in(sent(other)) is None


class TestTransaction:
    def cockpit(self) -> Cockpit:
        return Cockpit(config(), Endpoint(system_id=255))

    def outcomes(self, replies: dict[float, int], seconds: float) -> tuple[list[float], Outcome]:
        """When it sent, and how it ended, given the results at these times."""
        cockpit, transaction, sent_at_s = self.cockpit(), Transaction(arm()), []
        for k in range(round(seconds * 10)):
            cockpit.begin_tick()
            if k / 10 in replies:
                cockpit.replies.append(dialect.MAVLink_command_ack_message(400, replies[k / 10]))
            outcome = transaction.tick(cockpit, k / 10)
            if cockpit.endpoint.take():
                sent_at_s.append(k / 10)
            if outcome is not Outcome.OPEN:
                return sent_at_s, outcome
        return sent_at_s, Outcome.OPEN

    def test_silence_ends_after_five_sendings(self) -> None:
        assert self.outcomes({}, 9.0) == ([0.0, 0.5, 1.0, 1.5, 2.0], Outcome.SILENCE)

    def test_an_answer_ends_it(self) -> None:
        assert self.outcomes({0.7: 0}, 9.0) == ([0.0, 0.5], Outcome.ACCEPTED)
        assert self.outcomes({0.1: 4}, 9.0) == ([0.0], Outcome.REFUSED)

    def test_progress_buys_time(self) -> None:
        assert self.outcomes({0.2: 5}, 5.0) == ([0.0], Outcome.OPEN)
        assert self.outcomes({0.2: 5, 4.9: 0}, 9.0) == ([0.0], Outcome.ACCEPTED)

    def test_an_answer_from_before_the_question_does_not_count(self) -> None:
        assert self.outcomes({0.0: 4}, 0.3) == ([0.0], Outcome.OPEN)


class TestErrand:
    def test_accepted_without_effect_is_asked_again(self) -> None:
        cockpit = Cockpit(config(), Endpoint(system_id=255))
        errand = Errand(arm(), limit_s=60.0, done=lambda telemetry: telemetry.armed)
        asked = 0
        for k in range(50):
            cockpit.begin_tick()
            if k == 1:
                cockpit.replies.append(dialect.MAVLink_command_ack_message(400, 0))
            assert errand.tick(cockpit, k / 10) is Progress.OPEN
            asked += bool(cockpit.endpoint.take())
            if asked == 2:
                break
        assert asked == 2
        assert cockpit.take_events() == (Event(Level.WARNING, "arm: accepted, but without effect; asking again"),)
        cockpit.telemetry.armed = True
        assert errand.tick(cockpit, 9.0) is Progress.DONE

    def test_the_same_trouble_is_told_once(self) -> None:
        cockpit = Cockpit(config(), Endpoint(system_id=255))
        errand = Errand(arm(), limit_s=20.0)
        progress, now_s = Progress.OPEN, 0.0
        while progress is Progress.OPEN:
            cockpit.begin_tick()
            cockpit.replies.append(dialect.MAVLink_command_ack_message(400, 4))
            progress = errand.tick(cockpit, now_s)
            now_s += 0.1
        assert progress is Progress.GIVEN_UP
        assert [event.text for event in cockpit.take_events()] == [
            "arm: refused; asking again",
            "arm: refused; given up",
        ]


def test_takeoff_altitude_counts_as_the_flavor_says() -> None:
    cockpit = Cockpit(config(), Endpoint(system_id=255))
    assert Takeoff(since_s=0.0, ground_up_m=5.0).altitude_m(cockpit) == 11.0
    cockpit.flavor = replace(ARDUPILOT, takeoff_is_amsl=True)
    assert Takeoff(since_s=0.0, ground_up_m=5.0).altitude_m(cockpit) == pytest.approx(504.1)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"altitude_m": nan}, "altitude_m is nan, allowed is 2 to 500"),
        ({"system_id": 251}, "system_id is 251, allowed is 1 to 250"),
        ({"max_speed_m_s": 0.0}, "max_speed_m_s is 0.0, allowed is 0.1 to 50"),
        ({"home": GeoPoint(90.0, 0.0, 0.0)}, "is no place on the globe"),
        ({"home": GeoPoint(0.0, nan, 0.0)}, "is no place on the globe"),
    ],
)
def test_a_config_that_cannot_be_names_agent_field_and_range(changes: dict[str, Any], told: str) -> None:
    with pytest.raises(ValueError, match="pilot of agent 3") as error:
        config(**changes)
    assert told in str(error.value)
