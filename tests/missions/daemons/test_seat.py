"""What a process does for one agent when it is to end, and what it says to the world, and as whom."""

from __future__ import annotations

import pytest

from comms.radio import ANYBODY
from comms.status import Activity, AgentStatus
from missions.daemons import seat as seats
from missions.daemons.orders import Verb
from missions.daemons.seat import LEFT_TO_PERSON, Seat
from missions.daemons.wire import decode_done
from missions.exit_codes import DONE, FAILED
from missions.load import load_mission
from missions.observation import AgentTruth
from missions.sides.agent import AgentSide
from missions.sides.exchange import HELLO_TICK, Cue, Done
from missions.sides.phases import PERSONS_LIMIT_S

UID, LIFE = 2, 77
MISSION = load_mission("narrow")
LIMIT_TICKS = round(PERSONS_LIMIT_S / MISSION.tick_s)


class Script(AgentSide):
    """A side that is what a test says.

    Attributes:
        activity, on_ground, unheard: of its next done.
    """

    def __init__(self) -> None:
        self.uid = UID
        self.activity = Activity.EXPLORE
        self.on_ground = False
        self.unheard = False

    def hello(self) -> Done:
        return self._told(HELLO_TICK)

    def tick(self, cue: Cue) -> Done:
        return self._told(cue.tick)

    def _told(self, tick: int) -> Done:
        truth = AgentTruth((0.0, 0.0, 30.0), (0.0, 0.0, 0.0), 0.0)
        status = AgentStatus(uid=UID, activity=self.activity)
        return Done(tick=tick, status=status, truth=truth, on_ground=self.on_ground, unheard=self.unheard)


class Flight:
    """A seat in lockstep, its side, and what it has told the world."""

    def __init__(self) -> None:
        self.side, self.wires = Script(), list[bytes]()
        self.seat = Seat(self.side, self.wires.append, MISSION, life=LIFE, period_s=None)

    @property
    def told(self) -> list[Done]:
        dones = [decode_done(wire, UID, ANYBODY) for wire in self.wires]
        return [done for done in dones if done is not None]

    def tick(self, n: int = 1) -> None:
        for _ in range(n):
            self.seat.take(Cue(tick=self.seat.last.tick + 1, life=LIFE, world=5))


def test_all_that_it_says_is_of_its_life() -> None:
    flight = Flight()
    flight.seat.greet("print", world=5)
    flight.tick(2)
    assert [(done.tick, done.life, done.world, done.fingerprint) for done in flight.told] == [
        (HELLO_TICK, LIFE, 5, "print"),
        (0, LIFE, 5, ""),
        (1, LIFE, 5, ""),
    ]


def test_it_says_hello_when_the_world_has_forgotten_it(monkeypatch: pytest.MonkeyPatch) -> None:
    flight = Flight()
    flight.tick()
    flight.seat.greet("print")
    assert len(flight.told) == 1
    monkeypatch.setattr(seats, "FORGOTTEN_S", 0.0)
    flight.seat.greet("print")
    assert flight.told[-1].tick == HELLO_TICK
    flight.seat.end(DONE)
    flight.seat.greet("print")
    assert len(flight.told) == 2


def test_who_is_to_end_lands_first() -> None:
    flight = Flight()
    flight.seat.orders.take(Verb.STOP, Activity.EXPLORE)
    flight.side.activity = Activity.RETURNING
    flight.tick(3 * LIMIT_TICKS)
    assert not flight.seat.over
    flight.side.activity, flight.side.on_ground = Activity.LANDED, True
    flight.tick()
    assert (flight.seat.over, flight.seat.code, flight.told[-1].leaves) == (True, DONE, True)


@pytest.mark.parametrize(("on_ground", "code"), [(False, FAILED), (True, DONE)])
def test_a_vehicle_that_a_person_flies_is_left_to_them_after_a_while(on_ground: bool, code: int) -> None:
    flight = Flight()
    flight.side.activity, flight.side.on_ground = Activity.TAKEN_OVER, on_ground
    flight.tick(3 * LIMIT_TICKS)
    assert not flight.seat.over  # nobody has asked it to end
    flight.seat.orders.take(Verb.STOP, Activity.TAKEN_OVER)
    flight.tick(LIMIT_TICKS)
    assert not flight.seat.over
    flight.tick()
    assert (flight.seat.over, flight.seat.code) == (True, code)
    last = flight.told[-1]
    assert last.leaves
    assert [event.text for event in last.status.events] == [LEFT_TO_PERSON]


def test_who_is_given_its_vehicle_back_brings_it_home() -> None:
    flight = Flight()
    flight.seat.orders.take(Verb.STOP, Activity.EXPLORE)
    for activity in (Activity.TAKEN_OVER, Activity.RETURNING, Activity.TAKEN_OVER):
        flight.side.activity = activity
        flight.tick(LIMIT_TICKS - 1)
    assert not flight.seat.over


def test_who_is_dead_by_a_fault_and_in_the_air_has_failed() -> None:
    flight = Flight()
    flight.seat.orders.take(Verb.STOP, Activity.EXPLORE)
    flight.side.activity, flight.side.unheard = Activity.LOST, True
    flight.tick()
    assert (flight.seat.over, flight.seat.code) == (True, FAILED)
