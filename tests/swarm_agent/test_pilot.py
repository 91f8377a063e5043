"""The whole flight, and what can go wrong in each stage, against answers as the recorded ArduCopter gives them."""

from __future__ import annotations

from math import hypot, tau

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint
from comms.mavlink import Endpoint
from comms.status import Level
from swarm_agent.autopilot import Fly, Land, Phase, Pilot, Prepare, Return
from tests.swarm_agent.pilot_flight import Flight, config
from tests.swarm_agent.scripted_copter import GUIDED, HOME, LAND, RTL, SILENCE, ScriptedCopter

SETPOINT = dialect.MAVLink_set_position_target_local_ned_message
FAILED, REJECTED, DENIED, UNSUPPORTED, IN_PROGRESS = 4, 1, 2, 3, 5
ARM = dialect.MAV_CMD_COMPONENT_ARM_DISARM
SET_MODE = dialect.MAV_CMD_DO_SET_MODE
TAKEOFF = dialect.MAV_CMD_NAV_TAKEOFF
INTERVAL = dialect.MAV_CMD_SET_MESSAGE_INTERVAL


def flown(**changes: object) -> Flight:
    """A flight whose vehicle holds its layer."""
    flight = Flight(ScriptedCopter(**changes))  # type: ignore[arg-type]
    return flight.run(Prepare(), until=lambda: flight.pilot.state.ready)


class TestWholeFlight:
    def test_goes_through_every_phase_in_order(self) -> None:
        flight = Flight(ScriptedCopter(ready_at_s=3.0))
        flight.run(Prepare(), until=lambda: flight.pilot.state.ready)
        flight.run(Fly((2.0, 1.0)), seconds=5.0)
        flight.until(Phase.DONE, Return())
        assert flight.phases == [
            Phase.CONNECT,
            Phase.PREFLIGHT,
            Phase.ARM,
            Phase.TAKEOFF,
            Phase.ON_STATION,
            Phase.FLYING,
            Phase.RETURN,
            Phase.DONE,
        ]
        assert not flight.copter.armed
        assert flight.pilot.state.landed
        assert not [event for event in flight.events if event.level is not Level.INFO]
        assert flight.pilot.endpoint.bad == 0

    def test_own_frame_is_brought_into_the_missions(self) -> None:
        flight = flown(offset_m=(40.0, -30.0, 0.0))
        position_m = flight.pilot.state.position_m
        assert position_m is not None
        assert position_m == pytest.approx((40.0, -30.0, 16.0), abs=0.6)
        flight.run(Fly((3.0, -1.0)), seconds=10.0)
        position_m, velocity_m_s = flight.pilot.state.position_m, flight.pilot.state.velocity_m_s
        assert position_m is not None
        assert velocity_m_s is not None
        assert position_m == pytest.approx((70.0, -40.0, 16.0), abs=0.6)
        assert velocity_m_s == pytest.approx((3.0, -1.0, 0.0), abs=0.1)

    def test_a_vehicle_on_a_hill_flies_the_same_layer_and_returns_at_it(self) -> None:
        flight = flown(offset_m=(0.0, 50.0, 5.0))
        assert flight.copter.commands(TAKEOFF)[0].param7 == pytest.approx(11.0, abs=0.01)
        assert flight.copter.parameters["RTL_ALT"] == 1100.0
        assert flight.run(Prepare(), seconds=5.0).copter.local_ned_m[2] == pytest.approx(-11.0, abs=0.1)

    def test_reports_the_vehicle(self) -> None:
        state = flown().pilot.state
        assert (state.flight_mode, state.armed, state.landed, state.battery) == ("GUIDED", True, False, 0.83)
        assert state.heading_rad == pytest.approx(tau - 1.5)
        assert (state.link_lost, state.failure) == (False, "")

    def test_asks_for_ten_hertz_and_one(self) -> None:
        asked = {int(m.param1): m.param2 for m in flown().copter.commands(INTERVAL)}
        assert asked == {30: 1e5, 32: 1e5, 1: 1e6, 245: 1e6, 24: 1e6, 193: 1e6, 147: 1e6, 33: 1e6}

    def test_beats_once_a_second_as_a_ground_station(self) -> None:
        flight = Flight(ScriptedCopter()).run(Prepare(), seconds=20.0)
        beats = flight.copter.of(dialect.MAVLink_heartbeat_message)
        assert len(beats) == 20
        assert {(beat.type, beat.get_srcSystem(), beat.get_srcComponent()) for beat in beats} == {(6, 255, 191)}

    def test_same_input_same_output(self) -> None:
        def wire() -> list[str]:
            flight = Flight(ScriptedCopter(ready_at_s=2.0, script={ARM: [FAILED]}))
            flight.run(Prepare(), seconds=20.0).run(Fly((1.0, 2.0)), seconds=5.0).run(Return(), seconds=20.0)
            return [str(message) for message in flight.copter.heard]

        assert wire() == wire()


class TestConnect:
    def test_no_heartbeat_in_time_fails(self) -> None:
        flight = Flight(ScriptedCopter(quiet=True)).until(Phase.FAILED, Prepare(), seconds=62.0)
        assert flight.pilot.state.failure == "no heartbeat from system 4 in 60 s"

    def test_another_system_is_not_ours(self) -> None:
        flight = Flight(ScriptedCopter(system_id=5)).run(Prepare(), seconds=10.0)
        assert flight.phases == [Phase.CONNECT]

    def test_an_unknown_autopilot_is_named(self) -> None:
        flight = Flight(ScriptedCopter(autopilot=dialect.MAV_AUTOPILOT_PPZ)).until(Phase.FAILED, Prepare())
        assert flight.pilot.state.failure == "MAV_AUTOPILOT 9 is not supported, only ardupilot, px4"

    def test_return_before_any_heartbeat_ends(self) -> None:
        flight = Flight(ScriptedCopter(quiet=True)).until(Phase.FAILED, Return(), seconds=4.0)
        assert "no heartbeat" in flight.pilot.state.failure


class TestPreflight:
    def test_waits_for_position_and_checks_showing_the_reasons(self) -> None:
        flight = Flight(ScriptedCopter(ready_at_s=41.2)).run(Prepare(), seconds=20.0)
        flight.copter.say(2, "PreArm: Need Position Estimate")
        flight.run(Prepare(), seconds=21.0)
        assert flight.phases[-1] is Phase.PREFLIGHT
        assert "PreArm: Need Position Estimate" in flight.texts
        assert not flight.copter.commands(ARM)
        flight.run(Prepare(), seconds=20.0, until=lambda: flight.pilot.state.ready)

    def test_checks_that_never_pass_fail_with_the_autopilots_words(self) -> None:
        flight = Flight(ScriptedCopter(ready_at_s=1e9), preflight_limit_s=10.0).run(Prepare(), seconds=5.0)
        flight.copter.say(2, "PreArm: Compass not calibrated")
        flight.until(Phase.FAILED, Prepare())
        assert flight.pilot.state.failure == "waiting for a position after 10 s (PreArm: Compass not calibrated)"

    def test_rates_fall_back_to_streams(self) -> None:
        flight = Flight(ScriptedCopter(script={INTERVAL: [UNSUPPORTED] * 2}))
        flight.run(Prepare(), until=lambda: flight.pilot.state.ready)
        asked = flight.copter.of(dialect.MAVLink_request_data_stream_message)
        assert [(m.req_stream_id, m.req_message_rate, m.start_stop) for m in asked] == [(10, 10, 1), (6, 10, 1)]

    def test_return_altitude_is_confirmed_in_the_newer_units(self) -> None:
        flight = flown(parameters={"RTL_ALT_M": 15.0})
        assert flight.copter.parameters == {"RTL_ALT_M": 16.0}

    def test_a_vehicle_that_keeps_another_return_altitude_does_not_fly(self) -> None:
        flight = Flight(ScriptedCopter(parameters={}), refusal_limit_s=10.0).until(Phase.FAILED, Prepare())
        assert flight.pilot.state.failure == "set RTL_ALT_M to 16: no answer"
        assert not flight.copter.commands(ARM)

    def test_the_wrong_place_fails(self) -> None:
        flight = Flight(ScriptedCopter(), home=GeoPoint(47.0, 8.545594, 488.1)).until(Phase.FAILED, Prepare())
        assert flight.pilot.state.failure == "44.3 km from the mission's home: wrong home or wrong vehicle"

    def test_a_home_altitude_that_cannot_be_fails(self) -> None:
        home = GeoPoint(HOME.latitude_deg, HOME.longitude_deg, 0.0)
        flight = Flight(ScriptedCopter(), home=home).until(Phase.FAILED, Prepare())
        assert "does the mission's home altitude (0 m) fit?" in flight.pilot.state.failure

    def test_an_origin_that_moves_while_it_arms_is_no_takeoff(self) -> None:
        flight = Flight(ScriptedCopter(script={ARM: [SILENCE]})).until(Phase.ARM, Prepare())
        place = (round(HOME.latitude_deg * 1e7), round(HOME.longitude_deg * 1e7), 2**31 - 1)
        flight.copter.endpoint.send(dialect.MAVLink_gps_global_origin_message(*place, 0))
        flight.until(Phase.FAILED, Prepare())
        assert "above this vehicle's ground" in flight.pilot.state.failure
        assert not flight.copter.commands(TAKEOFF)

    def test_return_on_the_ground_is_done(self) -> None:
        flight = Flight(ScriptedCopter(ready_at_s=1e9)).run(Prepare(), seconds=3.0).until(Phase.DONE, Return())
        assert not flight.copter.commands(ARM)

    def test_a_restart_of_the_autopilot_starts_over(self) -> None:
        flight = Flight(ScriptedCopter(ready_at_s=1e9)).run(Prepare(), seconds=30.0)
        second = ScriptedCopter(offset_m=(7.0, 0.0, 0.0))
        flight.copter = RestartedClock(second)  # type: ignore[assignment]
        flight.run(Prepare(), until=lambda: flight.pilot.state.ready)
        assert "the autopilot has restarted: it is checked anew" in flight.texts
        position_m = flight.pilot.state.position_m
        assert position_m is not None
        assert position_m[0] == pytest.approx(7.0, abs=0.1)

    def test_found_flying_it_is_flown_on(self) -> None:
        copter = ScriptedCopter(armed=True, mode=GUIDED, local_ned_m=[10.0, 0.0, -12.0])
        flight = Flight(copter)
        flight.run(Prepare(), until=lambda: flight.pilot.state.ready)
        assert not copter.commands(ARM)
        assert not copter.commands(TAKEOFF)
        assert not copter.commands(SET_MODE)

    def test_found_flying_under_another_hand_it_is_left_alone(self) -> None:
        copter = ScriptedCopter(armed=True, mode=3, local_ned_m=[10.0, 0.0, -12.0])
        flight = Flight(copter).run(Prepare(), seconds=30.0)
        assert flight.phases[-1] is Phase.TAKEN_OVER
        assert not copter.commands(SET_MODE)
        assert not copter.of(SETPOINT)


class RestartedClock:
    """A vehicle that booted when it was put on the wire."""

    def __init__(self, copter: ScriptedCopter) -> None:
        self.copter = copter
        self.ticks = 0

    def tick(self, now_s: float, wire_in: bytes) -> bytes:
        self.ticks += 1
        return self.copter.tick(self.ticks * 0.1, wire_in)


class TestArmAndTakeoff:
    def test_a_refusal_is_reported_with_its_reason_and_retried(self) -> None:
        flight = flown(script={ARM: [FAILED, REJECTED]}, words={ARM: "Arm: Gyros inconsistent"})
        assert "arm: refused (Arm: Gyros inconsistent); asking again" in flight.texts
        assert len(flight.copter.commands(ARM)) == 3

    def test_arming_refused_for_good_fails_with_the_reason(self) -> None:
        copter = ScriptedCopter(script={ARM: [FAILED] * 1000}, words={ARM: "Arm: Throttle too high"})
        flight = Flight(copter).until(Phase.FAILED, Prepare(), seconds=70.0)
        assert flight.pilot.state.failure == "arm: refused (Arm: Throttle too high)"
        assert flight.now_s == pytest.approx(61.0, abs=3.0)

    def test_an_unsupported_command_is_not_repeated(self) -> None:
        flight = Flight(ScriptedCopter(script={TAKEOFF: [UNSUPPORTED] * 9})).until(Phase.FAILED, Prepare())
        assert len(flight.copter.commands(TAKEOFF)) == 1
        assert flight.pilot.state.failure == "takeoff to 16.0 m: not supported"

    def test_a_lost_answer_is_asked_for_again(self) -> None:
        flight = flown(script={TAKEOFF: [SILENCE, SILENCE]})
        assert [m.confirmation for m in flight.copter.commands(TAKEOFF)] == [0, 1, 2]

    def test_return_while_climbing_comes_down(self) -> None:
        flight = Flight(ScriptedCopter())
        flight.run(Prepare(), until=lambda: flight.copter.local_ned_m[2] < -5.0)
        flight.until(Phase.DONE, Return(), seconds=30.0)
        assert Phase.ON_STATION not in flight.phases

    def test_return_with_motors_on_the_ground_disarms(self) -> None:
        flight = Flight(ScriptedCopter(script={TAKEOFF: [IN_PROGRESS] * 9}))
        flight.run(Prepare(), until=lambda: flight.pilot.state.phase is Phase.TAKEOFF)
        flight.until(Phase.DONE, Return(), seconds=5.0)
        assert not flight.copter.armed

    def test_disarmed_by_itself_on_the_ground_it_is_armed_again(self) -> None:
        flight = Flight(ScriptedCopter(script={TAKEOFF: [FAILED]})).until(Phase.TAKEOFF, Prepare())
        flight.copter.armed = False
        flight.run(Prepare(), until=lambda: flight.pilot.state.ready)
        assert "disarmed before takeoff: arming again" in flight.texts

    def test_a_climb_that_stops_short_is_finished_by_setpoints(self) -> None:
        flight = Flight(ScriptedCopter()).until(Phase.TAKEOFF, Prepare())
        flight.run(Prepare(), until=lambda: flight.copter.local_ned_m[2] < -5.0)
        flight.copter.climb_to_m, flight.copter.velocity_ned_m_s = None, (0.0, 0.0, 0.0)
        flight.run(Prepare(), seconds=30.0, until=lambda: flight.pilot.state.ready)
        assert any(text.startswith("takeoff stopped at 5.") for text in flight.texts)


class TestFlying:
    def test_one_setpoint_a_tick_with_the_layer_held(self) -> None:
        flight = flown()
        flight.copter.local_ned_m[2] = -20.0
        before = len(flight.copter.of(SETPOINT))
        flight.run(Fly((0.0, 2.0)), seconds=10.0)
        setpoints = flight.copter.of(SETPOINT)[before:]
        assert len(setpoints) == 100
        assert {(m.type_mask, m.coordinate_frame, m.target_system) for m in setpoints} == {(0xDC7, 1, 4)}
        assert max(abs(m.vz) for m in setpoints) <= 1.5
        assert flight.copter.local_ned_m[2] == pytest.approx(-16.0, abs=0.2)

    @pytest.mark.parametrize("wish", [(30.0, -40.0), (1e300, 1e300), (-5.0, 0.0), (3.0, 4.0)])
    def test_never_faster_than_allowed(self, wish: tuple[float, float]) -> None:
        flight = flown().run(Fly(wish), seconds=2.0)
        fastest = max(hypot(m.vx, m.vy) for m in flight.copter.of(SETPOINT))
        assert fastest == pytest.approx(5.0, abs=1e-5) or wish == (1e300, 1e300)
        assert fastest <= 5.0 + 1e-5

    @pytest.mark.parametrize("wish", [(float("nan"), 0.0), (float("inf"), 1.0), (0.0, float("-inf"))])
    def test_what_is_no_number_never_leaves(self, wish: tuple[float, float]) -> None:
        flight = flown().run(Fly(wish), seconds=2.0)
        assert {(m.vx, m.vy) for m in flight.copter.of(SETPOINT)} == {(0.0, 0.0)}
        assert sum("holding still" in text for text in flight.texts) == 1

    def test_not_flown_before_the_layer_is_reached(self) -> None:
        flight = Flight(ScriptedCopter())
        flight.run(Fly((3.0, 0.0)), until=lambda: flight.pilot.state.ready)
        assert hypot(*flight.copter.local_ned_m[:2]) < 0.5

    def test_without_a_fresh_position_it_holds_still(self) -> None:
        flight = flown().run(Fly((3.0, 0.0)), seconds=1.0)
        flight.copter.streams.clear()
        flight.run(Fly((3.0, 0.0)), seconds=3.0)
        last = flight.copter.of(SETPOINT)[-1]
        assert (last.vx, last.vy, last.vz) == (0.0, 0.0, 0.0)
        assert "no position for 1.5 s: holding still" in flight.texts
        flight.run(Fly((3.0, 0.0)), seconds=30.0, until=lambda: flight.copter.of(SETPOINT)[-1].vy == 3.0)
        assert "telemetry has fallen silent: asking for it again" in flight.texts

    def test_a_lost_link_is_told_and_so_is_its_return(self) -> None:
        flight = flown()
        flight.copter.quiet = True
        flight.run(Prepare(), seconds=6.5)
        assert flight.pilot.state.link_lost
        assert "link lost: no heartbeat for 5 s" in flight.texts
        flight.copter.quiet = False
        flight.run(Prepare(), seconds=2.0)
        assert not flight.pilot.state.link_lost
        assert "the link is back" in flight.texts

    def test_a_failsafe_is_followed_down(self) -> None:
        flight = flown()
        flight.copter.mode = LAND
        flight.until(Phase.DONE, Fly((1.0, 0.0)), seconds=60.0)
        assert Phase.LAND in flight.phases
        assert "in LAND without being asked: following it down" in flight.texts
        assert len(flight.copter.commands(SET_MODE)) == 1

    def test_hands_off_when_taken_over_and_on_again_when_guided(self) -> None:
        flight = flown()
        flight.copter.mode = 5
        flight.until(Phase.TAKEN_OVER, Fly((1.0, 0.0)), seconds=2.0)
        setpoints = len(flight.copter.of(SETPOINT))
        flight.run(Fly((1.0, 0.0)), seconds=10.0)
        assert len(flight.copter.of(SETPOINT)) <= setpoints + 1
        flight.copter.mode = GUIDED
        flight.until(Phase.FLYING, Fly((1.0, 0.0)), seconds=3.0)

    def test_motors_off_in_the_air_is_a_failure(self) -> None:
        flight = flown()
        flight.copter.armed = False
        flight.until(Phase.FAILED, Fly((1.0, 0.0)), seconds=2.0)
        assert flight.pilot.state.failure == "disarmed in the air"


class TestWayDown:
    def test_return_is_commanded_once_and_goes_home(self) -> None:
        flight = flown().run(Fly((3.0, 3.0)), seconds=10.0).until(Phase.DONE, Return(), seconds=60.0)
        assert [m.param2 for m in flight.copter.commands(SET_MODE)] == [GUIDED, RTL]
        assert hypot(*flight.copter.local_ned_m[:2]) < 1.0

    def test_a_refused_return_becomes_a_landing(self) -> None:
        flight = flown()
        flight.copter.script = {SET_MODE: [FAILED] * 5}
        flight.copter.words = {SET_MODE: "Mode change to RTL failed: requires position"}
        flight.until(Phase.DONE, Return(), seconds=60.0)
        assert flight.phases[-3:] == [Phase.RETURN, Phase.LAND, Phase.DONE]
        assert "mode RTL: refused (Mode change to RTL failed: requires position); given up" in flight.texts

    def test_a_way_down_refused_for_good_fails_but_keeps_asking(self) -> None:
        flight = flown()
        flight.copter.script = {SET_MODE: [FAILED] * 1000}
        flight.until(Phase.FAILED, Return(), seconds=90.0)
        assert flight.pilot.state.failure == "mode LAND: refused"
        flight.copter.script = {}
        flight.run(Return(), seconds=60.0, until=lambda: not flight.copter.armed)

    def test_land_is_on_the_spot(self) -> None:
        flight = flown().run(Fly((0.0, 3.0)), seconds=10.0).until(Phase.DONE, Land(), seconds=60.0)
        assert flight.copter.local_ned_m[0] > 25.0
        assert Phase.LAND in flight.phases

    def test_a_return_that_never_ends_becomes_a_landing(self) -> None:
        flight = Flight(ScriptedCopter(), return_limit_s=5.0)
        flight.run(Prepare(), until=lambda: flight.pilot.state.ready)
        flight.run(Fly((5.0, 0.0)), seconds=40.0).until(Phase.DONE, Return(), seconds=60.0)
        assert Phase.LAND in flight.phases
        assert flight.copter.local_ned_m[1] > 100.0


class TestWire:
    def test_answers_to_a_ground_station_are_not_ours(self) -> None:
        pilot, copter = Pilot(config()), Endpoint(system_id=4)
        copter.send(dialect.MAVLink_heartbeat_message(2, 3, 81, 0, 3, 3))
        pilot.tick(0.0, copter.take(), Prepare())
        copter.send(dialect.MAVLink_command_ack_message(INTERVAL, DENIED, 0, 0, 255, 190))
        out = Endpoint(system_id=4).receive(pilot.tick(0.1, copter.take(), Prepare()))
        assert not [m for m in out if m.get_msgId() == dialect.MAVLINK_MSG_ID_REQUEST_DATA_STREAM]

    def test_a_flood_is_cut_and_told(self) -> None:
        pilot = Pilot(config())
        pilot.tick(0.0, b"\xfd" * 70_000, Prepare())
        assert pilot.take_events()[0].text == "70000 bytes in one tick: not all of it is heard"
