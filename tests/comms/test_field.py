"""Radios without an air: who hears whom, when, and what a mate's own session keeps out."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from comms.codec import encode
from comms.field import FieldRadio
from comms.keys import Keys
from comms.messages import Frame
from comms.radio import Radio, Roster
from comms.session import Bus, BusError, open_local_bus, open_peer
from comms.turns import MAX_EACH
from tests.missions.daemons.swarm import free_endpoint
from tests.patience import until

KEYS, ROSTER = Keys("test"), Roster(n_agents=3)


@pytest.fixture
def bus() -> Iterator[Bus]:
    with open_local_bus() as bus:
        yield bus


def frame(src: int, seq: int = 1, sent_at_s: float = 0.0) -> Frame:
    return Frame(src, seq, sent_at_s, 0.5, (0.0, 0.0, 10.0), (0.0, 0.0, 0.0))


def radios_on(bus: Bus, n: int) -> list[FieldRadio]:
    return [FieldRadio(bus, keys=KEYS, uid=uid, roster=ROSTER) for uid in range(n)]


def heard(radio: Radio, now_s: float) -> list[tuple[int, int]]:
    return [(frame.src, frame.seq) for frame in radio.drain(now_s)]


def test_everybody_is_heard_by_all_others_and_not_by_itself(bus: Bus) -> None:
    radios = radios_on(bus, 3)
    for uid, radio in enumerate(radios):
        radio.send(frame(uid))
    assert [heard(radio, 0.1) for radio in radios] == [[(1, 1), (2, 1)], [(0, 1), (2, 1)], [(0, 1), (1, 1)]]
    assert [(radio.count.sent, radio.count.accepted, radio.count.refused) for radio in radios] == [(1, 2, 0)] * 3
    assert radios[0].count.bytes == len(encode(frame(0)))


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_who_speaks_first_in_a_tick_is_heard_in_the_next_one_like_all(bus: Bus, order: tuple[int, ...]) -> None:
    radios = radios_on(bus, 3)
    for tick in range(5):
        for uid in order:
            now_s = tick * 0.1
            before = [(mate, tick) for mate in range(3) if mate != uid and tick]
            assert radios[uid].waiting(now_s) == len(before)
            assert heard(radios[uid], now_s) == before
            radios[uid].send(frame(uid, seq=tick + 1, sent_at_s=now_s))


def test_who_is_switched_off_forgets_what_was_and_not_what_is_being_said(bus: Bus) -> None:
    radios = radios_on(bus, 3)
    radios[0].send(frame(0, seq=1, sent_at_s=0.0))
    radios[1].send(frame(1, seq=2, sent_at_s=0.1))
    radios[2].forget(0.1)
    assert heard(radios[2], 0.2) == [(1, 2)]


@pytest.mark.parametrize(
    ("src", "wire", "reason"),
    [
        (1, encode(frame(2, seq=7, sent_at_s=9.9)), "bad"),
        (1, b"rubbish", "bad"),
        (1, bytes(5000), "bad"),
        (1, encode(frame(1, seq=7, sent_at_s=9.4)), "stale"),
        (1, encode(frame(1, seq=7, sent_at_s=10.501)), "early"),
        (1, encode(frame(1, seq=5, sent_at_s=9.9)), "replayed"),
        (3, encode(frame(3, seq=7, sent_at_s=9.9)), "strange"),
    ],
    ids=["of somebody else", "no frame", "too long", "of the past", "of the future", "replayed", "of a stranger"],
)
def test_a_hostile_frame_is_counted_and_changes_nothing(bus: Bus, src: int, wire: bytes, reason: str) -> None:
    [radio] = radios_on(bus, 1)
    bus.publisher(KEYS.tx(1))(encode(frame(1, seq=5, sent_at_s=9.8)))
    assert len(radio.drain(10.0)) == 1
    bus.publisher(KEYS.tx(src))(wire)
    assert radio.drain(10.0) == []
    assert (getattr(radio.count, reason), radio.count.refused) == (1, 1)


def test_a_clock_that_is_ahead_is_heard_when_ours_gets_there(bus: Bus) -> None:
    [radio] = radios_on(bus, 1)
    bus.publisher(KEYS.tx(1))(encode(frame(1, sent_at_s=10.25)))
    assert [heard(radio, now_s) for now_s in (10.0, 10.1, 10.2, 10.3)] == [[], [], [], [(1, 1)]]
    assert radio.count.refused == 0


@pytest.mark.parametrize("sent_at_s", [0.0, 0.1, 0.4], ids=["before", "now", "of the future"])
def test_who_shouts_pushes_out_nobody_else(bus: Bus, sent_at_s: float) -> None:
    radio, mate, _ = radios_on(bus, 3)
    mate.send(frame(1, sent_at_s=0.0))
    put = bus.publisher(KEYS.tx(2))
    for seq in range(10_000):
        put(encode(frame(2, seq=seq, sent_at_s=sent_at_s)))
    last = [(2, seq) for seq in range(10_000 - MAX_EACH, 10_000)]
    assert heard(radio, 0.1) == [(1, 1), *(last if sent_at_s == 0.0 else [])]
    assert radio.count.refused == 10_000 - MAX_EACH
    assert heard(radio, 0.5) == (last if sent_at_s else [])


# What agent 1 puts on its own key in a tick -> the numbers of its frames that are heard, and how much is refused.
@pytest.mark.parametrize(
    ("wires", "numbers", "refused"),
    [
        ([encode(frame(1, seq=5)), b"rubbish"], [5], 1),
        ([b"rubbish", encode(frame(1, seq=5)), b"more"], [5], 2),
        ([encode(frame(1, seq=5)), encode(frame(1, seq=6)), encode(frame(1, seq=4))], [6], 2),
        ([encode(frame(1, seq=5)), encode(frame(2, seq=9))], [5], 1),
        ([b"rubbish", b"more"], [], 2),
    ],
    ids=["rubbish behind", "rubbish around", "three frames", "a frame of somebody else", "rubbish alone"],
)
@pytest.mark.parametrize("at_once", [True, False], ids=["counted at the end", "counted after each"])
def test_in_lockstep_each_counts_once_a_tick_whatever_it_says(
    bus: Bus, wires: list[bytes], numbers: list[int], refused: int, at_once: bool
) -> None:
    radio, _, mate = radios_on(bus, 3)
    mate.send(frame(2, seq=3))
    put = bus.publisher(KEYS.tx(1))
    for wire in wires:
        put(wire)
        assert at_once or radio.waiting(0.1) == 2
    assert radio.waiting(0.1) == 2
    assert radio.surplus == len(wires) - 1
    assert heard(radio, 0.1) == [*[(1, number) for number in numbers], (2, 3)]
    assert radio.count.refused == refused
    assert radio.waiting(0.2) == radio.surplus == 0


def test_a_computer_that_stands_still_keeps_one_of_each_a_tick(bus: Bus) -> None:
    radio, mate, other = radios_on(bus, 3)
    for tick in range(5):
        mate.send(frame(1, seq=tick, sent_at_s=tick * 0.1))
        other.send(frame(2, seq=tick, sent_at_s=tick * 0.1))
        for _ in range(5):
            bus.publisher(KEYS.tx(2))(b"rubbish")
        assert radio.waiting((tick + 1) * 0.1) == 2 * (tick + 1)
    assert heard(radio, 0.5) == [(src, seq) for src in (1, 2) for seq in range(5)]
    assert radio.count.refused == 25


def test_what_is_old_by_the_mission_is_not_believed_whatever_it_says_itself(bus: Bus) -> None:
    radio = FieldRadio(bus, keys=KEYS, uid=0, roster=ROSTER, ttl_s=0.5)
    put = bus.publisher(KEYS.tx(1))
    for age_s in (0.6, 0.4):
        put(encode(frame(1, seq=1, sent_at_s=100.0 - age_s)._replace(ttl_s=3600.0)))
    assert heard(radio, 100.0) == [(1, 1)]
    assert radio.count.stale == 1


def test_peers_hear_each_other_directly_whoever_comes_late_or_again() -> None:
    endpoints = sorted(free_endpoint() for _ in range(3))
    with ExitStack() as stack:
        buses = [stack.enter_context(open_peer(endpoints[uid], endpoints[:uid])) for uid in (0, 1)]
        radios = [FieldRadio(bus, keys=KEYS, uid=uid, roster=ROSTER) for uid, bus in enumerate(buses)]
        for life in range(2):  # the third comes late, goes, and comes back
            with open_peer(endpoints[2], endpoints[:2]) as bus:
                third = FieldRadio(bus, keys=KEYS, uid=2, roster=ROSTER)
                said = 1000 * life

                def all_hear(third: FieldRadio = third) -> bool:
                    nonlocal said
                    said += 1
                    now_s = said * 0.1
                    for radio in (*radios, third):
                        radio.send(frame(radio.uid, seq=said, sent_at_s=now_s))
                    return all(
                        {frame.src for frame in radio.drain(now_s + 0.1)} == {0, 1, 2} - {radio.uid}
                        for radio in (*radios, third)
                    )

                until(all_hear)


def test_a_peer_that_cannot_listen_says_so() -> None:
    endpoint = free_endpoint()
    with (
        open_peer(endpoint, []),
        pytest.raises(BusError, match="is it a free port of this machine"),
        open_peer(endpoint, []),
    ):
        pytest.fail("two listen on one port")
