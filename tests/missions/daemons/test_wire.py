"""What passes between processes: the same on the other side, and nothing but what it should be."""

from __future__ import annotations

from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs

from comms.clock import Lockstep
from comms.knowledge import Belief, Knowledge, Mate
from comms.radio import ANYBODY, Roster
from comms.session import open_local_bus
from comms.status import Activity, AgentStatus, Event, HelpCallStatus, Level
from missions.daemons.believable import MOST_LETTERS, most_done_bytes
from missions.daemons.wire import decode_cue, decode_done, decode_observation, encode
from missions.flight import Flight
from missions.load import load_mission
from missions.observation import AgentTruth, Observation, Phase
from missions.overrides import Override
from missions.sides.exchange import Cue, Done, LinkCount, RadioTally

ROSTER = Roster(n_agents=3, n_targets=5)
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
    roster = Roster(n_agents=3, n_targets=4)

    class Notes:
        def observe(self, observation: Observation) -> None:
            seen.append(observation)

    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.side.explain_every_s = 1.0
        flight.run(pace=Lockstep(), observers=[Notes()], stop=lambda: False)
    assert all(decode_observation(encode(observation), roster) == observation for observation in seen)
    assert [decode_done(encode(done), uid, roster) for uid, done in enumerate(flight.side.dones)] == flight.side.dones


def test_a_cue_passes_unchanged() -> None:
    cue = Cue(tick=4, mission_tick=1, come_home=True, frames=None)
    assert decode_cue(encode(cue)) == cue


@pytest.mark.parametrize("number", [nan, inf, -inf, FAR])
def test_a_vehicle_must_be_somewhere(number: float) -> None:
    assert decode_done(encode(DONE), 2, ANYBODY) == DONE
    assert decode_done(encode(DONE), 1, ANYBODY) is None  # speaks for another
    for truth in (
        AgentTruth((number, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0),
        AgentTruth((0.0, 0.0, 0.0), (0.0, number, 0.0), 0.0),
        AgentTruth((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), number if number != FAR else nan),
    ):
        assert decode_done(encode(structs.replace(DONE, truth=truth)), 2, ANYBODY) is None


@given(st.binary(max_size=200))
def test_rubbish_is_nothing(wire: bytes) -> None:
    for decode in (
        decode_cue,
        lambda wire: decode_observation(wire, ROSTER),
        lambda wire: decode_done(wire, 2, ROSTER),
    ):
        decode(wire)
        decode(encode(DONE)[: len(wire)] + wire)


def test_what_is_too_long_is_not_looked_at() -> None:
    assert decode_done(encode(DONE) + b" " * most_done_bytes(ROSTER), 2, ROSTER) is None


def test_it_must_speak_of_whom_the_mission_has() -> None:
    assert decode_done(encode(DONE), 2, ROSTER) == DONE
    for changes in (
        {"tags": (5,)},
        {"tags": (-1,)},
        {"helping": 2**63},
        {"mates": (3,)},
        {"calls": (HelpCallStatus(5, 1.0),)},
        {"knowledge": Knowledge(beliefs=(Belief(target=5, place_m=(0.0, 0.0)),))},
        {"knowledge": Knowledge(beliefs=(Belief(target=4, place_m=(0.0, 0.0), owner=3),))},
        {"knowledge": Knowledge(mates=(Mate(3, (0.0, 0.0), 0.0),))},
    ):
        assert (
            decode_done(encode(structs.replace(DONE, status=structs.replace(DONE.status, **changes))), 2, ROSTER)
            is None
        )


@pytest.mark.parametrize("number", [-1, 2**48 + 1, 2**64 - 1])
def test_what_is_counted_can_be_added_up(number: int) -> None:
    for counts in ({"pilot": LinkCount(sent=number)}, {"radio": RadioTally(bytes=number)}):
        assert decode_done(encode(structs.replace(DONE, **counts)), 2, ROSTER) is None


def test_what_an_agent_says_is_a_line() -> None:
    status = structs.replace(DONE.status, events=(Event(Level.ERROR, "x" * 20_000),))
    done = decode_done(encode(structs.replace(DONE, status=status)), 2, ROSTER)
    assert done is not None
    assert done.status.events == (Event(Level.ERROR, "x" * MOST_LETTERS),)


def test_an_observation_may_hold_all_that_agents_may_say() -> None:
    status = structs.replace(DONE.status, flight_mode="x" * (most_done_bytes(ROSTER) - 1000))
    assert decode_done(encode(structs.replace(DONE, status=status)), 2, ROSTER) is not None
    seen = Observation(
        tick=3, time_s=0.3, phase=Phase.MISSION, statuses=(status,) * ROSTER.n_agents, truths=(), targets=()
    )
    assert decode_observation(encode(seen), ROSTER) == seen
