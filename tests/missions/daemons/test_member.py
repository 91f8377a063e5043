"""Which process speaks for an agent: one at a time, let in by its hello alone, with the counts of those before it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs

from comms.status import Activity, AgentStatus, Event, Level
from missions.daemons.member import MOST_LIVES, MOST_RIVALS, SURE_S, Member
from missions.observation import AgentTruth
from missions.sides.exchange import HELLO_TICK, Done, LinkCount, RadioTally

UID = 3


def done(tick: int, *, life: int, count: int = 0, said: str = "", leaves: bool = False) -> Done:
    events = (Event(Level.ERROR, said),) if said else ()
    return Done(
        tick=tick,
        status=AgentStatus(uid=UID, activity=Activity.EXPLORE, tags=(1,), events=events),
        truth=AgentTruth((float(tick), 0.0, 30.0), (0.0, 0.0, 0.0), 0.0),
        on_ground=False,
        life=life,
        leaves=leaves,
        pilot=LinkCount(count, 2 * count, 3 * count, 4 * count),
        vehicle=LinkCount(received=count),
        radio=RadioTally(count, count, count, count),
    )


def hello(life: int, *, count: int = 0) -> Done:
    return done(HELLO_TICK, life=life, count=count)


def met(life: int = 7) -> Member:
    member = Member(UID)
    assert member.greet(hello(life), 0.0)
    member.is_new = False
    return member


def test_a_done_lets_nobody_in() -> None:
    member = Member(UID)
    member.hear(done(0, life=7), 0.0)
    assert not member.is_there
    assert member.greet(hello(7), 0.1)
    member.lose(1.0)
    member.hear(done(5, life=7, said="motor 3 failed"), 1.1)
    assert not member.is_there
    assert member.last.status.activity is Activity.LOST
    assert [event.text for event in member.news] == ["motor 3 failed"]  # what it said is told all the same
    assert member.greet(hello(7), 1.2)


def test_what_comes_late_is_told_but_does_not_move_anybody_back() -> None:
    member = met()
    member.hear(done(9, life=7, said="nine"), 1.0)
    member.hear(done(8, life=7, said="eight"), 1.1)
    told = member.tell(9, may_be_back=True)
    assert told.truth.position_m[0] == 9.0
    assert [event.text for event in told.status.events] == ["nine", "eight"]
    assert member.tell(10, may_be_back=True).status.events == ()


def test_who_was_away_and_is_back_is_not_taken_for_where_it_was_before() -> None:
    member = met()
    member.hear(done(9, life=7), 1.0)
    member.lose(2.0)
    assert member.greet(hello(7), 3.0)
    member.hear(done(8, life=7), 3.1)
    assert member.last.tick == HELLO_TICK
    assert not member.owes(8)
    member.is_new = False
    assert member.owes(20)


def test_a_second_process_is_not_heard_and_refused_once_the_first_is_known_to_live() -> None:
    member = met()
    assert not member.greet(hello(8), 1.0)
    member.hear(done(4, life=8, count=100, said="I am A3"), 1.1)
    assert member.last == structs.replace(hello(7), status=structs.replace(hello(7).status, events=()))
    assert not member.news
    member.hear(done(4, life=7), 1.0 + SURE_S)
    assert not member.is_rival_in_vain(8)  # that may have been said before it died
    member.hear(done(5, life=7), 1.1 + SURE_S)
    assert member.is_rival_in_vain(8)
    assert not member.is_rival_in_vain(9)


def test_a_second_process_waits_for_the_death_of_the_first() -> None:
    member = met()
    assert not member.greet(hello(8), 1.0)
    assert not member.greet(hello(8), 60.0)
    assert not member.is_rival_in_vain(8)
    member.lose(60.1)
    assert member.greet(hello(8), 60.2)
    assert not member.greet(hello(7), 60.3)
    member.hear(done(30, life=7), 60.4)
    assert member.last.life == 8


def test_before_the_mission_hellos_are_signs_of_life() -> None:
    member = met()
    member.greet(hello(8), 1.0)
    member.greet(hello(7), 1.1 + SURE_S)
    assert member.is_rival_in_vain(8)
    assert member.heard_at_s == 0.0  # nothing new was done


def test_rivals_do_not_fill_the_memory() -> None:
    member = met()
    for life in range(100, 100 + 10 * MOST_RIVALS):
        member.greet(hello(life), 1.0)
    member.hear(done(4, life=7), 10.0)
    assert sum(member.is_rival_in_vain(life) for life in range(100, 1000)) == MOST_RIVALS


def test_counts_of_former_lives_stay() -> None:
    member = met()
    for life, counts in ((7, (3, 10)), (8, (1, 5)), (9, (2,))):
        for tick, count in enumerate(counts):
            member.hear(done(tick, life=life, count=count), 0.0)
        member.lose(1.0)
        member.greet(hello(life), 2.0)  # cut off, and back: the same life counts once
        member.hear(done(50, life=life, count=counts[-1]), 2.1)
        member.lose(3.0)
        member.greet(hello(life + 1), 4.0)
    total = 10 + 5 + 2
    assert member.last.pilot == LinkCount(total, 2 * total, 3 * total, 4 * total)
    assert member.last.vehicle == LinkCount(received=total)
    assert member.last.radio == RadioTally(total, total, total, total)


@pytest.mark.parametrize("leaves", [False, True])
def test_who_leaves_is_not_waited_for_and_may_come_again(leaves: bool) -> None:
    member = met()
    member.hear(done(4, life=7, leaves=leaves), 1.0)
    assert member.is_there is not leaves
    assert member.owes(5) is not leaves
    assert member.greet(hello(8), 2.0) is leaves


STEPS = st.lists(
    st.tuples(st.sampled_from(["hello", "done", "lose", "leave"]), st.integers(1, 3), st.integers(0, 20)), max_size=60
)


@given(steps=STEPS)
def test_one_life_speaks_at_a_time_and_no_count_is_lost(steps: list[tuple[str, int, int]]) -> None:
    """Three processes say hello, do ticks, are lost and leave, in any order."""
    member = Member(UID)
    counts, known = {1: 0, 2: 0, 3: 0}, {1: 0, 2: 0, 3: 0}
    for now, (what, life, more) in enumerate(steps):
        was_there, speaker, before = member.is_there, member.life, member.done
        if what == "lose" and was_there:
            member.lose(float(now))
        elif what == "hello":
            let_in = member.greet(hello(life, count=counts[life]), float(now))
            assert let_in is not was_there
            assert member.life == (life if let_in else speaker)
            known[life] = counts[life] if let_in else known[life]
        elif what in ("done", "leave"):
            counts[life] += more
            member.hear(done(now, life=life, count=counts[life], said="heard", leaves=what == "leave"), float(now))
            is_heard = was_there and life == speaker
            assert (member.done is not before) is is_heard
            assert bool(member.news) is (life == speaker)
            known[life] = counts[life] if is_heard else known[life]
            member.news.clear()
        if member.done is not None:
            assert member.done.pilot.sent == member.done.radio.heard == sum(known.values())


def test_counts_stay_however_often_it_is_started_again() -> None:
    member = Member(UID)
    for life in range(1, 5 * MOST_LIVES):
        member.greet(hello(life), 0.0)
        member.hear(done(life, life=life, count=2), 0.0)
        assert member.last.pilot.sent == 2 * life
        member.lose(0.0)
