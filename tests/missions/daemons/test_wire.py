"""What passes between processes: the same on the other side, and nothing but what it should be."""

from __future__ import annotations

from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs

from comms.clock import Lockstep
from comms.session import open_local_bus
from comms.status import Activity, AgentStatus
from missions.daemons.wire import MAX_BYTES, decode_cue, decode_done, decode_observation, encode
from missions.flight import Flight
from missions.load import load_mission
from missions.observation import AgentTruth, Observation
from missions.overrides import Override
from missions.sides.exchange import Cue, Done

FAR = 1e307  # finite, and nowhere
DONE = Done(
    tick=3,
    status=AgentStatus(uid=2, activity=Activity.FOLLOW, tags=(1, 4)),
    truth=AgentTruth((1.0, 2.0, 3.0), (0.1, 0.2, 0.3), 1.5),
    on_ground=False,
)


def test_a_whole_flight_passes_unchanged() -> None:
    changes = ("agents.count=3", "targets.count=4", "duration_s=5", "vehicle.boot_s=0.5")
    mission = load_mission("narrow", overrides=[Override(text) for text in changes])
    seen: list[Observation] = []

    class Notes:
        def observe(self, observation: Observation) -> None:
            seen.append(observation)

    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.side.explain_every_s = 1.0
        flight.run(pace=Lockstep(), observers=[Notes()], stop=lambda: False)
    assert all(decode_observation(encode(observation)) == observation for observation in seen)
    assert [decode_done(encode(done), uid) for uid, done in enumerate(flight.side.dones)] == flight.side.dones


def test_a_cue_passes_unchanged() -> None:
    cue = Cue(tick=4, mission_tick=1, come_home=True, frames=None)
    assert decode_cue(encode(cue)) == cue


@pytest.mark.parametrize("number", [nan, inf, -inf, FAR])
def test_a_vehicle_must_be_somewhere(number: float) -> None:
    assert decode_done(encode(DONE), 2) == DONE
    assert decode_done(encode(DONE), 1) is None  # speaks for another
    for truth in (
        AgentTruth((number, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0),
        AgentTruth((0.0, 0.0, 0.0), (0.0, number, 0.0), 0.0),
        AgentTruth((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), number if number != FAR else nan),
    ):
        assert decode_done(encode(structs.replace(DONE, truth=truth)), 2) is None


@given(st.binary(max_size=200))
def test_rubbish_is_nothing(wire: bytes) -> None:
    for decode in (decode_cue, decode_observation, lambda wire: decode_done(wire, 2)):
        decode(wire)
        decode(encode(DONE)[: len(wire)] + wire)


def test_what_is_too_long_is_not_looked_at() -> None:
    assert decode_done(encode(DONE) + b" " * MAX_BYTES, 2) is None
