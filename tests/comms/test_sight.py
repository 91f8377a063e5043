"""What a detector says: what is believed of it, for how long, and what is not."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from comms.keys import Keys
from comms.messages import Sighting
from comms.session import open_local_bus
from comms.sight import MAX_BYTES, MAX_TARGETS_SEEN, MAX_WAITING, Eyes

KEYS = Keys("test")
NOW_S = 1_764_113_400.25
ONE = {"target": 1, "east_m": 3.0, "north_m": -4.0, "east_m_s": 0.5, "north_m_s": -1.0}


@pytest.fixture
def say_and_eyes() -> Iterator[tuple[Callable[[Any], None], Eyes]]:
    with open_local_bus() as bus:
        eyes = Eyes(bus, keys=KEYS, uid=4, n_targets=3)
        put = bus.publisher(KEYS.sight(4))

        def say(what: Any) -> None:
            put(what if isinstance(what, bytes) else json.dumps(what).encode())

        yield say, eyes


def sight(*targets: dict[str, Any], at_s: float = NOW_S) -> dict[str, Any]:
    return {"at_s": at_s, "targets": list(targets)}


def test_what_is_seen_moves_on_and_ends(say_and_eyes: tuple[Callable[[Any], None], Eyes]) -> None:
    say, eyes = say_and_eyes
    assert eyes.see(NOW_S) == ()
    say(sight(ONE, {"target": 0, "east_m": 1, "north_m": 2}))
    assert eyes.see(NOW_S) == (Sighting(1, 3.0, -4.0), Sighting(0, 1.0, 2.0))
    [moved, still] = eyes.see(NOW_S + 0.25)
    assert moved == pytest.approx((1, 3.125, -4.25))
    assert still == Sighting(0, 1.0, 2.0)
    assert eyes.see(NOW_S + 0.75) == ()
    assert (eyes.count.accepted, eyes.count.bad, eyes.count.untimely) == (1, 0, 0)


def test_the_newest_picture_counts_and_an_empty_one_is_nobody(
    say_and_eyes: tuple[Callable[[Any], None], Eyes],
) -> None:
    say, eyes = say_and_eyes
    say(sight(ONE, at_s=NOW_S))
    say(sight({"target": 2, "east_m": 0, "north_m": 0}, at_s=NOW_S - 0.1))  # older, and comes later
    assert [seen.target for seen in eyes.see(NOW_S)] == [1]
    say(sight(at_s=NOW_S + 0.1))
    assert eyes.see(NOW_S + 0.1) == ()
    assert (eyes.count.accepted, eyes.count.untimely) == (2, 1)


@pytest.mark.parametrize(
    ("wire", "reason"),
    [
        (b"", "bad"),
        (b"\xff\x00rubbish", "bad"),
        (b"[" * 60_000, "bad"),
        (b" " * (MAX_BYTES + 1), "bad"),
        ([1, 2, 3], "bad"),
        ({"targets": [ONE]}, "bad"),
        ({"at_s": None, "targets": []}, "bad"),
        (b'{"at_s": 1e999, "targets": []}', "bad"),
        (b'{"at_s": NaN, "targets": []}', "bad"),
        (sight(ONE | {"target": 3}), "bad"),
        (sight(ONE | {"target": -1}), "bad"),
        (sight(ONE | {"target": 1.5}), "bad"),
        (sight(ONE | {"east_m": 100_001}), "bad"),
        (sight(ONE | {"north_m_s": -501}), "bad"),
        (sight(ONE | {"north": 1}), "bad"),
        (sight(*[ONE] * (MAX_TARGETS_SEEN + 1)), "bad"),
        (sight(ONE, at_s=NOW_S - 0.51), "untimely"),
        (sight(ONE, at_s=NOW_S + 0.11), "untimely"),
    ],
)
def test_what_is_no_sight_of_now_is_counted_and_changes_nothing(
    say_and_eyes: tuple[Callable[[Any], None], Eyes], wire: Any, reason: str
) -> None:
    say, eyes = say_and_eyes
    say(sight(ONE))
    assert len(eyes.see(NOW_S)) == 1
    say(wire)
    assert eyes.see(NOW_S) == (Sighting(1, 3.0, -4.0),)
    assert getattr(eyes.count, reason) == 1


def test_who_shouts_does_not_fill_the_memory(say_and_eyes: tuple[Callable[[Any], None], Eyes]) -> None:
    say, eyes = say_and_eyes
    for _ in range(1000):
        say(b"rubbish")
    eyes.see(NOW_S)
    assert eyes.count.bad == MAX_WAITING
