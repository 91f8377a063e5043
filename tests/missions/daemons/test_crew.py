"""The barrier of a tick, over a bus without a network: who is waited for, who is lost, and who is let in."""

from __future__ import annotations

import threading
from dataclasses import replace
from time import monotonic

import pytest
from msgspec import structs

from comms.air import Air, LinkModel
from comms.keys import Keys
from comms.radio import Roster
from comms.status import Activity, AgentStatus, Event, Level
from missions.daemons import member
from missions.daemons.crew import BACK, DIED, LEFT_IN_AIR, MOST_IN_VAIN, UNHEARD, CrewError, Patience, RemoteCrew
from missions.daemons.wire import FOREIGN, STRANGE, TAKEN, UNRELIABLE, decode_cue, encode
from missions.observation import AgentTruth
from missions.sides.exchange import HELLO_TICK, Cue, Done, LinkCount
from missions.sides.medium import Medium, OpenField, SimulatedAir
from tests.missions.daemons.fake_bus import FakeBus

KEYS = Keys("toy")
PRINT = "the mission's"
N_AGENTS = 3
LONG_S = 30.0
LOCKSTEP = Patience(join_s=LONG_S, tick_s=0.3, lost_s=0.3, back_s=0.0, lockstep=True)
IN_REAL_TIME = Patience(join_s=LONG_S, tick_s=0.02, lost_s=LONG_S, back_s=0.0, lockstep=False)


class Process:
    """A process of agent `uid` that does a tick for each cue, unless it is `busy`, and `speaks` in it, or says so.

    Attributes:
        cued: the ticks that it was told to do. refused: why it was not let in. world: that it has met.
    """

    def __init__(self, bus: FakeBus, uid: int, *, life: int, fingerprint: str = PRINT, world: int = 0) -> None:
        self.uid = uid
        self.world = world
        self.cued: list[int] = []
        self.refused = ""
        self.busy = False
        self.speaks = False
        self._bus = bus
        self._life = life
        self._fingerprint = fingerprint
        bus.subscribe(KEYS.cue(uid), self._hear)
        bus.appear(KEYS.alive(uid))

    def hello(self) -> None:
        self._put(structs.replace(self.done(HELLO_TICK), fingerprint=self._fingerprint))

    def do(self, tick: int, *, said: str = "", leaves: bool = False) -> None:
        self._put(structs.replace(self.done(tick, said=said, leaves=leaves), spoke=self.speaks))

    def done(self, tick: int, *, said: str = "", leaves: bool = False) -> Done:
        events = (Event(Level.INFO, said),) if said else ()
        return Done(
            tick=tick,
            status=AgentStatus(uid=self.uid, activity=Activity.EXPLORE, events=events),
            truth=AgentTruth((float(tick), 0.0, 30.0), (0.0, 0.0, 0.0), 0.0),
            on_ground=False,
            leaves=leaves,
            life=self._life,
            world=self.world,
            pilot=LinkCount(sent=max(0, tick)),
        )

    def die(self) -> None:
        self.busy = True
        self._bus.appear(KEYS.alive(self.uid), is_there=False)

    def _put(self, done: Done) -> None:
        self._bus.publish(KEYS.done(self.uid), encode(done))

    def _hear(self, key: str, payload: bytes) -> None:
        cue = decode_cue(payload)
        if cue is None or cue.life != self._life:
            return
        if cue.refused:
            self.refused = cue.refused
            return
        self.world = cue.world
        self.cued.append(cue.tick)
        if not self.busy:
            self.do(cue.tick)


class Mission:
    """A crew of three processes that has met, and what is told of it."""

    def __init__(self, patience: Patience = LOCKSTEP, medium: Medium | None = None) -> None:
        self.bus = FakeBus()
        self.told: list[tuple[int, str]] = []
        self.crew = RemoteCrew(
            self.bus,
            keys=KEYS,
            roster=Roster(N_AGENTS),
            medium=medium or OpenField(N_AGENTS),
            patience=patience,
            fingerprint=PRINT,
            tell=lambda uid, event: self.told.append((uid, event.text)),
            stop=lambda: False,
        )
        self.processes = [Process(self.bus, uid, life=10 + uid) for uid in range(N_AGENTS)]
        for process in self.processes:
            process.hello()
        assert [done.tick for done in self.crew.hello()] == [HELLO_TICK] * N_AGENTS
        self._tick = 0

    def tick(self, n: int = 1) -> list[Done]:
        """Do so many ticks; what came of the last."""
        dones: list[Done] = []
        for _ in range(n):
            dones = self.crew.tick([Cue(tick=self._tick, frames=0) for _ in range(N_AGENTS)])
            self._tick += 1
        return dones


def said(done: Done) -> list[str]:
    return [event.text for event in done.status.events]


def test_everybody_is_cued_and_answers() -> None:
    mission = Mission()
    dones = mission.tick(3)
    assert [done.tick for done in dones] == [2, 2, 2]
    assert [process.cued for process in mission.processes] == [[0, 1, 2]] * N_AGENTS
    assert not mission.told
    assert not mission.crew.lost


def test_nobody_waits_for_ever_for_those_who_do_not_come() -> None:
    with pytest.raises(CrewError, match=r"no sign of agent 0, 1, 2"):
        RemoteCrew(
            FakeBus(),
            keys=KEYS,
            roster=Roster(N_AGENTS),
            medium=OpenField(N_AGENTS),
            patience=replace(LOCKSTEP, join_s=0.0),
            fingerprint=PRINT,
            tell=lambda uid, event: None,
            stop=lambda: False,
        ).hello()


def test_who_does_not_answer_is_lost_until_it_says_hello() -> None:
    mission = Mission()
    agent = mission.processes[1]
    agent.busy = True
    [_, lost, _] = mission.tick()
    assert lost.status.activity is Activity.LOST
    [why] = said(lost)
    assert why.startswith("no answer for ")
    agent.do(0, said="landed")  # its flight home, as it may be: no reason to wait for it
    [_, lost, _] = mission.tick()
    assert lost.status.activity is Activity.LOST
    assert said(lost) == ["landed"]
    assert agent.cued == [0]
    agent.busy = False
    agent.hello()
    [_, back, _] = mission.tick()
    assert (back.tick, back.status.activity) == (2, Activity.EXPLORE)
    assert said(back) == [BACK]
    assert mission.crew.lost == {1}


def test_a_death_ends_the_wait_at_once() -> None:
    mission = Mission(replace(LOCKSTEP, tick_s=LONG_S))
    mission.processes[2].busy = True
    death = threading.Timer(0.05, mission.processes[2].die)
    death.start()
    began_s = monotonic()
    dones = mission.tick()
    death.join()
    assert monotonic() - began_s < LONG_S / 2
    assert said(dones[2]) == [DIED]


def test_the_death_of_one_that_the_mission_does_not_have_is_nothing() -> None:
    mission = Mission()
    stranger = Process(mission.bus, N_AGENTS + 4, life=99)
    stranger.hello()
    stranger.die()
    assert [done.tick for done in mission.tick()] == [0, 0, 0]
    assert not mission.told


def test_what_is_said_late_and_at_once_is_told_in_the_next_tick() -> None:
    mission = Mission(IN_REAL_TIME)
    agent = mission.processes[0]
    agent.busy = True
    assert said(mission.tick(2)[0]) == []
    agent.do(0, said="motor 3 failed")
    agent.do(1, said="lands")
    late = mission.tick()[0]
    assert said(late) == ["motor 3 failed", "lands"]
    assert late.truth.position_m[0] == 1.0
    assert not late.spoke
    assert not mission.crew.lost


def test_what_is_of_a_tick_to_come_is_not_believed() -> None:
    mission = Mission(IN_REAL_TIME)
    mission.processes[0].busy = True
    mission.processes[0].do(500)
    assert mission.tick()[0].tick == HELLO_TICK


def test_a_stranger_is_told_so_and_changes_nothing() -> None:
    mission = Mission()
    stranger = Process(mission.bus, 1, life=99, fingerprint="another mission's")
    stranger.hello()
    stranger.do(0, said="I am A1")
    dones = mission.tick(2)
    assert stranger.refused == STRANGE
    assert not stranger.cued
    assert said(dones[1]) == []
    assert mission.processes[1].cued == [0, 1]
    assert mission.told == [(1, STRANGE)]
    stranger.hello()
    mission.tick()
    assert mission.told == [(1, STRANGE)]


def test_a_second_process_of_an_agent_is_refused_and_the_first_flies_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(member, "SURE_S", 0.0)
    mission = Mission()
    mission.tick()
    second = Process(mission.bus, 1, life=99)
    second.hello()
    mission.tick()
    assert not second.refused  # the first might have died since it spoke
    second.do(1, said="I am A1")
    second.hello()
    [_, first, _] = mission.tick()
    assert second.refused == TAKEN
    assert not second.cued
    assert said(first) == []
    assert mission.processes[1].cued == [0, 1, 2]
    assert not mission.processes[1].refused
    assert mission.told == [(1, TAKEN)]
    assert not mission.crew.lost


def test_an_agent_that_is_started_again_waits_until_its_death_is_noticed() -> None:
    mission = Mission()
    mission.tick(5)
    mission.processes[1].busy = True  # it has died, and nobody was told
    second = Process(mission.bus, 1, life=99)
    second.hello()
    [_, lost, _] = mission.tick()
    assert lost.status.activity is Activity.LOST
    second.hello()
    [_, back, _] = mission.tick()
    assert second.cued == [6]
    assert not second.refused
    assert back.pilot.sent == 4 + 6  # of both lives
    mission.processes[1].do(5, said="of the past")
    assert said(mission.tick()[1]) == []


def test_a_death_and_a_new_life_between_two_ticks_hold_nobody_up() -> None:
    mission = Mission(replace(LOCKSTEP, tick_s=LONG_S))
    agent = mission.processes[1]
    agent.busy = True

    def rise() -> None:
        agent.die()
        Process(mission.bus, 1, life=99).hello()

    death = threading.Timer(0.05, rise)
    death.start()
    began_s = monotonic()
    mission.tick()
    death.join()
    assert monotonic() - began_s < LONG_S / 2
    assert mission.crew.lost == {1}


def test_who_leaves_its_vehicle_to_a_person_is_lost() -> None:
    mission = Mission(IN_REAL_TIME)
    agent = mission.processes[1]
    agent.busy = True
    mission.tick()
    agent.do(0, said="it is left to them", leaves=True)
    [_, left, _] = mission.tick()
    assert said(left) == ["it is left to them", LEFT_IN_AIR]
    assert left.status.activity is Activity.LOST
    assert agent.cued == [0]


def test_who_says_that_it_spoke_and_has_not_is_lost_alone() -> None:
    bus = FakeBus()
    air = Air(bus, keys=KEYS, model=LinkModel(range_m=10.0), n_agents=N_AGENTS, tick_s=0.1, seed=1)
    mission = Mission(medium=SimulatedAir(air))
    mission.processes[2].speaks = True
    dones = mission.tick()
    assert [done.spoke for done in dones] == [False] * N_AGENTS
    assert dones[2].status.activity is Activity.LOST
    assert mission.told == [(2, UNHEARD)]
    assert mission.crew.lost == {2}
    assert [done.tick for done in mission.tick()] == [1, 1, 0]


def test_who_holds_up_everybody_again_and_again_is_not_let_in_any_more() -> None:
    mission = Mission()
    mute = mission.processes[1]
    mute.busy = True
    for _ in range(MOST_IN_VAIN):
        assert not mute.refused
        mission.tick()
        mute.hello()
        mission.tick(0)
    mission.tick()
    assert mute.refused == UNRELIABLE
    assert [done.tick for done in mission.tick()] == [4, -1, 4]


def test_who_has_met_another_world_is_not_let_in_until_it_is_started_anew() -> None:
    old, mission = Mission(), Mission()
    old.tick()
    mission.tick()
    assert old.processes[1].world not in (0, mission.processes[1].world)
    mission.processes[1].die()
    mission.tick()
    foreign = Process(mission.bus, 1, life=99, world=old.processes[1].world)
    for _ in range(2):
        foreign.hello()
        [_, lost, _] = mission.tick()
        assert lost.status.activity is Activity.LOST
    assert (foreign.refused, foreign.cued) == (FOREIGN, [])
    assert mission.told == [(1, DIED), (1, FOREIGN)]
    anew = Process(mission.bus, 1, life=100)
    anew.hello()
    mission.tick()
    assert (anew.refused, anew.cued) == ("", [4])


def test_who_was_cut_off_from_the_same_world_is_let_in() -> None:
    mission = Mission()
    mission.tick()
    agent = mission.processes[1]
    mission.bus.appear(KEYS.alive(1), is_there=False)
    mission.tick()
    assert agent.world != 0
    agent.hello()
    mission.tick()
    assert (agent.refused, agent.cued) == ("", [0, 2])


def test_where_the_next_life_is_there_one_of_another_world_leaves_the_vehicle_to_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(member, "SURE_S", 0.0)
    mission = Mission()
    foreign = Process(mission.bus, 1, life=99, world=7)
    for _ in range(2):
        foreign.hello()
        mission.tick()
    assert foreign.refused == TAKEN
