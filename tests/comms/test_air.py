"""Frames through real zenoh: who hears whom, what is refused, and in which order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import pytest

from comms.air import Air, LinkModel
from comms.bundle import MAX_BUNDLE_BYTES, bundle, unbundle
from comms.codec import MAX_FRAME_BYTES, encode
from comms.keys import Keys, sender
from comms.link import delay_ticks, survives
from comms.messages import Answer, Frame, HelpCall, Tag
from comms.radio import Radio, Roster
from comms.session import Bus, open_local_bus
from comms.turns import MAX_EACH

KEYS = Keys("test")


@pytest.fixture
def bus() -> Iterator[Bus]:
    with open_local_bus() as bus:
        yield bus


def frame(src: int, seq: int = 1, sent_at_s: float = 0.0) -> Frame:
    return Frame(src, seq, sent_at_s, 0.5, (0.0, 0.0, 10.0), (0.0, 0.0, 0.0))


def swarm(bus: Bus, n: int, **model: float) -> tuple[Air, list[Radio]]:
    link = LinkModel(**{"range_m": 20.0, **model})
    air = Air(bus, keys=KEYS, model=link, n_agents=n, tick_s=0.1, seed=5)
    return air, [Radio(bus, keys=KEYS, uid=uid) for uid in range(n)]


def everybody_speaks(
    air: Air, radios: Sequence[Radio], places: Sequence[tuple[float, float]], tick: int = 0
) -> list[list[int]]:
    for uid, radio in enumerate(radios):
        radio.send(frame(uid, seq=tick + 1, sent_at_s=tick * 0.1))
    air.carry(tick, places)
    return [[heard.src for heard in radio.drain((tick + 1) * 0.1)] for radio in radios]


def heard_of(bus: Bus, src: int) -> Callable[[bytes], None]:
    """How the air lets agent 0 hear a frame of `src`."""
    put = bus.publisher(KEYS.rx(0))
    return lambda frame: put(bundle([(src, frame)]))


def test_within_range_everything_arrives_and_beyond_it_nothing(bus: Bus) -> None:
    air, radios = swarm(bus, 4)
    places = [(0.0, 0.0), (20.0, 0.0), (20.001, 0.0), (0.0, -19.9)]
    for tick in range(50):
        assert everybody_speaks(air, radios, places, tick) == [[1, 3], [0, 2], [1], [0]]
    assert air.count.sent == 200
    assert air.count.delivered == 50 * 6
    assert air.count.out_of_range == 50 * 6
    assert air.count.lost == 0
    assert air.links == ((0, 1), (0, 3), (1, 2))


def test_range_follows_the_true_positions(bus: Bus) -> None:
    air, radios = swarm(bus, 2)
    heard = [everybody_speaks(air, radios, [(0.0, 0.0), (float(x), 0.0)], tick=x) for x in range(15, 26)]
    assert heard == [[[1], [0]]] * 6 + [[[], []]] * 5


def test_random_loss_takes_its_share_and_is_the_same_again(bus: Bus) -> None:
    air, radios = swarm(bus, 5, loss=0.3)
    for tick in range(400):
        everybody_speaks(air, radios, [(0.0, 0.0)] * 5, tick)
    assert air.count.delivered + air.count.lost == 400 * 20
    assert air.count.lost / (400 * 20) == pytest.approx(0.3, abs=0.02)
    again = sum(not survives(5, tick, a, b, 0.3) for tick in range(400) for a in range(5) for b in range(5) if a != b)
    assert again == air.count.lost


@pytest.mark.parametrize(("latency_s", "ticks"), [(0.0, 1), (0.1, 1), (0.11, 2), (0.3, 3)])
def test_a_frame_is_heard_after_its_latency_at_least_a_tick(bus: Bus, latency_s: float, ticks: int) -> None:
    assert delay_ticks(latency_s, 0.1) == ticks
    air, radios = swarm(bus, 2, latency_s=latency_s)
    radios[0].send(frame(0))
    heard_at = []
    for tick in range(6):
        air.carry(tick, [(0.0, 0.0), (1.0, 0.0)])
        heard_at += [tick + 1 for _ in radios[1].drain((tick + 1) * 0.1)]
    assert heard_at == [ticks]


def test_an_agent_hears_its_own_receiver_alone(bus: Bus) -> None:
    air, radios = swarm(bus, 3)
    everybody_speaks(air, radios, [(0.0, 0.0), (1.0, 0.0), (500.0, 0.0)])
    assert radios[2].waiting(0.1) == 0
    assert radios[2].count.accepted == 0


def test_frames_are_sorted_by_sender_and_number(bus: Bus) -> None:
    radio = Radio(bus, keys=KEYS, uid=0)
    for heard in [[(2, 1), (1, 4)], [(1, 3), (2, 2)]]:
        bus.publisher(KEYS.rx(0))(bundle([(src, encode(frame(src, seq))) for src, seq in heard]))
    assert [(heard.src, heard.seq) for heard in radio.drain(0.1)] == [(1, 3), (1, 4), (2, 1), (2, 2)]


def test_what_cannot_be_believed_is_counted_and_dropped(bus: Bus) -> None:
    radio = Radio(bus, keys=KEYS, uid=0)
    put = heard_of(bus, 1)
    put(encode(frame(1, seq=5)))
    put(b"rubbish")
    put(encode(frame(2, seq=6)))  # claims to be somebody else
    put(encode(frame(1, seq=5)))  # replayed
    put(encode(frame(1, seq=4)))  # late behind a newer one
    assert [heard.seq for heard in radio.drain(0.2)] == [4, 5]
    assert (radio.count.accepted, radio.count.bad, radio.count.replayed) == (2, 2, 1)
    put(encode(frame(1, seq=9)))
    assert radio.drain(0.6) == []
    assert radio.count.stale == 1


NOWHERE = (0.0, 0.0, 0.0, 0.0)
CALL = HelpCall(2, *NOWHERE, 1.0, 0.0)
TOO_LONG = encode(frame(1, seq=7)) + bytes(MAX_FRAME_BYTES)
NAN = encode(frame(1, seq=7)).replace(b"\xcd\x27\x10", b"\xcb\x7f\xf8" + bytes(6))  # 10 m up, as a double that is none


@pytest.mark.parametrize(
    ("wire", "reason"),
    [
        (TOO_LONG, "bad"),
        (NAN, "bad"),
        (encode(frame(2, seq=7)), "bad"),
        (encode(frame(1, seq=7)._replace(tags=(Tag(3, *NOWHERE, 1.0),))), "strange"),
        (encode(frame(1, seq=7)._replace(help_calls=(CALL, CALL._replace(target=3)))), "strange"),
        (encode(frame(1, seq=7)._replace(answers=(Answer(40_000, 1.0),))), "strange"),
        (encode(frame(1, seq=7, sent_at_s=10.501)), "early"),
        (encode(frame(1, seq=7, sent_at_s=9.4)), "stale"),
        (encode(frame(1, seq=5, sent_at_s=10.0)), "replayed"),
    ],
    ids=[
        "too long",
        "not a number",
        "of somebody else",
        "tag of no target",
        "call for no target",
        "answer",
        "of the future",
        "of the past",
        "replayed",
    ],
)
def test_a_hostile_frame_is_counted_and_changes_nothing(bus: Bus, wire: bytes, reason: str) -> None:
    radio = Radio(bus, keys=KEYS, uid=0, roster=Roster(n_agents=2, n_targets=3))
    put = heard_of(bus, 1)
    put(encode(frame(1, seq=5, sent_at_s=9.9)))
    assert len(radio.drain(10.0)) == 1
    assert wire != encode(frame(1, seq=7))
    put(wire)
    assert radio.drain(10.0) == []
    assert (getattr(radio.count, reason), radio.count.refused) == (1, 1)
    put(
        encode(frame(1, seq=6, sent_at_s=10.4))
    )  # what it says itself is believed as before, from a clock that is ahead
    assert [heard.seq for heard in radio.drain(10.0)] == [6]


def test_an_agent_that_the_mission_does_not_have_is_not_heard(bus: Bus) -> None:
    radio = Radio(bus, keys=KEYS, uid=0, roster=Roster(n_agents=2, n_targets=3))
    for src in (1, 2):
        heard_of(bus, src)(encode(frame(src, seq=1)._replace(help_calls=(CALL,))))
    assert [heard.src for heard in radio.drain(0.1)] == [1]
    assert radio.count.strange == 1


@pytest.mark.parametrize(
    "wire",
    [
        b"",
        b"rubbish",
        b"\xc0",
        bundle([(1, b"x")])[:-1],
        bundle([(-1, b"x")]),
        b"\x91" * 5000,
        bytes(MAX_BUNDLE_BYTES + 1),
    ],
    ids=["empty", "rubbish", "nothing", "cut", "of nobody", "deep", "too long"],
)
def test_what_is_no_bundle_is_counted_and_changes_nothing(bus: Bus, wire: bytes) -> None:
    assert unbundle(wire) is None
    radio = Radio(bus, keys=KEYS, uid=0)
    bus.publisher(KEYS.rx(0))(wire)
    assert radio.drain(0.1) == []
    assert radio.count.bad == 1


def test_a_bundle_is_opened_as_it_was_made() -> None:
    heard = [(src, bytes([src]) * src) for src in range(200)]
    assert unbundle(bundle(heard)) == heard


def test_who_shouts_is_not_carried(bus: Bus) -> None:
    air, radios = swarm(bus, 2)
    for _ in range(3):
        bus.publisher(KEYS.tx(1))(TOO_LONG)
    assert air.missing([0, 1]) == [0, 1]
    assert everybody_speaks(air, radios, [(0.0, 0.0), (1.0, 0.0)]) == [[1], [0]]
    assert (air.count.sent, air.count.refused) == (2, 3)


def test_a_stranger_on_the_air_is_not_carried(bus: Bus) -> None:
    air, radios = swarm(bus, 2)
    bus.publisher(KEYS.tx(77))(encode(frame(77)))
    assert everybody_speaks(air, radios, [(0.0, 0.0), (1.0, 0.0)]) == [[1], [0]]
    assert air.count.sent == 2


def test_keys_round_trip() -> None:
    assert KEYS.tx(7) == "swarm/@v1/test/tx/7"
    assert KEYS.rx(7) == "swarm/@v1/test/rx/7"
    assert sender(KEYS.tx(7)) == 7
    assert sender(KEYS.rx(7)) == 7
    assert sender("swarm/@v1/test/tx/x") is None


@pytest.mark.parametrize("name", ["", "a/b", "*", "a b", "x" * 65, "@v1"])
def test_a_mission_name_must_be_one_chunk(name: str) -> None:
    with pytest.raises(ValueError, match="not usable in a key"):
        Keys(name)


def test_who_says_too_much_pushes_out_nobody_else(bus: Bus) -> None:
    air, radios = swarm(bus, 3)
    for uid in (0, 1):
        radios[uid].send(frame(uid))
    put = bus.publisher(KEYS.tx(2))
    for seq in range(1000):
        put(encode(frame(2, seq=seq)))
    assert air.missing([0, 1, 2]) == []
    air.carry(0, [(0.0, 0.0)] * 3)
    last = list(range(1000 - MAX_EACH, 1000))
    assert [(heard.src, heard.seq) for heard in radios[0].drain(0.1)] == [(1, 1), *((2, seq) for seq in last)]
    assert air.count.refused == 1000 - MAX_EACH
