"""Several links to one vehicle: each has its own rates, sequence numbers and answers; news goes to all."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from comms.mavlink import BYTES_IN, Endpoint
from tests.vehicle_sim.autopilot.ground_station import GUIDED, GroundStation, order, ready
from vehicle_sim.autopilot.channel import Channel

ATTITUDE_ID = 30


def second_link(station: GroundStation) -> tuple[Channel, Endpoint]:
    return station.vehicle.open_channel(), Endpoint(system_id=254, component_id=190)


def tick(station: GroundStation, channel: Channel, ground: Endpoint, *messages: Any, seconds: float = 0.1) -> list[Any]:
    """Send on the second link, let time pass, and return what came back there."""
    for message in messages:
        ground.send(message)
    channel.hear(ground.take())
    station.tick(seconds=seconds)
    return ground.receive(channel.take())


def kinds(messages: list[Any]) -> list[str]:
    return [message.get_type() for message in messages]


def test_answers_go_where_the_question_came_from() -> None:
    station = ready()
    channel, ground = second_link(station)
    before = len(station.all("COMMAND_ACK"))
    heard = tick(station, channel, ground, order(410))
    assert kinds(heard).count("COMMAND_ACK") == kinds(heard).count("HOME_POSITION") == 1
    ack = next(message for message in heard if message.get_type() == "COMMAND_ACK")
    assert (ack.target_system, ack.target_component) == (254, 190)
    assert len(station.all("COMMAND_ACK")) == before
    assert station.order(410) == 0
    assert "COMMAND_ACK" not in kinds(tick(station, channel, ground))


def test_rates_are_the_links_own() -> None:
    station = ready()
    channel, ground = second_link(station)
    tick(station, channel, ground, order(511, ATTITUDE_ID, 200_000))
    heard = tick(station, channel, ground, seconds=2.0)
    assert kinds(heard).count("ATTITUDE") == 10
    assert station.all("ATTITUDE") == []


def test_news_goes_to_all() -> None:
    station = ready()
    channel, ground = second_link(station)
    assert station.order(400, 1) == 0
    heard = tick(station, channel, ground)
    assert "Arming motors" in [message.text for message in heard if message.get_type() == "STATUSTEXT"]
    assert any(m.get_type() == "HEARTBEAT" and m.base_mode & 128 and m.custom_mode == GUIDED for m in heard)
    assert "HOME_POSITION" in kinds(heard)


def test_sequence_numbers_have_no_gap_on_either_link() -> None:
    station = ready()
    channel, ground = second_link(station)
    seen = tick(station, channel, ground, order(511, ATTITUDE_ID, 100_000), seconds=5.0)
    station.stream(ATTITUDE_ID)
    station.tick(seconds=5.0)
    for messages in (seen, [message for _, message in station.log]):
        numbers = [message.get_seq() for message in messages]
        assert [(b - a) % 256 for a, b in pairwise(numbers)] == [1] * (len(numbers) - 1)


def test_a_flood_on_one_link_leaves_the_other_alone() -> None:
    station = ready()
    channel, _ = second_link(station)
    for _ in range(3):
        channel.hear(bytes(BYTES_IN))
    assert channel.endpoint.dropped == 2
    assert station.order(410) == 0
