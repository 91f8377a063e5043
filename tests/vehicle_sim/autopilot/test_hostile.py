"""Noise, floods and clocks that stand still. The storm of hostile frames is `tests/fuzz`."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.mavlink import BYTES_IN, BYTES_OF_A_SOURCE, BYTES_OUT, Endpoint
from tests.vehicle_sim.autopilot.ground_station import SYSTEM, flying, velocity


@given(noise=st.binary(max_size=300))
def test_noise_on_the_line_moves_nothing(noise: bytes) -> None:
    station = flying()
    before = station.vehicle.truth.position_ned_m
    station.vehicle.tick(station.now_s + 0.1, noise)
    assert station.vehicle.truth.position_ned_m[:2] == before[:2]
    assert station.vehicle.truth.armed


def test_a_flood_is_cut_and_the_vehicle_flies_on() -> None:
    station = flying()
    for _ in range(1200):
        station.out.send(velocity(1.0))
    flood = station.out.take() * 3
    assert len(flood) > BYTES_IN
    before = station.vehicle.endpoint.received
    station.vehicle.tick(station.now_s + 0.1, flood)
    assert 0 < station.vehicle.endpoint.received - before <= BYTES_OF_A_SOURCE / 60
    assert station.vehicle.endpoint.dropped > 100
    station.ticks += 1
    for _ in range(30):
        station.tick(velocity(1.0))
    assert station.vehicle.truth.velocity_ned_m_s[0] > 0.8


def test_a_flood_of_one_source_leaves_room_for_another() -> None:
    station, other = flying(), Endpoint(system_id=42)
    for _ in range(400):
        station.out.send(velocity(0.0))
    other.send(velocity(2.0))
    flood = station.out.take() * 2
    assert BYTES_OF_A_SOURCE < len(flood) < BYTES_IN
    station.vehicle.tick(station.now_s + 0.1, flood + other.take())
    station.ticks += 1
    station.tick(seconds=1.5)
    assert station.vehicle.truth.velocity_ned_m_s[0] > 1.0


def test_a_thousand_questions_get_as_many_answers_as_fit_and_the_heartbeat_goes_on() -> None:
    station = flying()
    for _ in range(900):
        station.out.send(dialect.MAVLink_param_request_list_message(SYSTEM, 1))
    questions, beats = station.out.take(), 0
    for _ in range(30):
        station.ticks += 1
        answers = station.vehicle.tick(station.now_s, questions)
        assert len(answers) <= BYTES_OUT + 21
        beats += sum(message.get_type() == "HEARTBEAT" for message in Endpoint(system_id=255).receive(answers))
    assert beats == 3
    assert station.vehicle.endpoint.dropped > 1000


def test_time_that_stands_still_or_runs_back_changes_nothing() -> None:
    station = flying()
    truth = station.vehicle.truth
    station.vehicle.tick(station.now_s, b"")
    station.vehicle.tick(station.now_s - 5.0, b"")
    assert station.vehicle.truth == truth
