"""The mission protocol against one vehicle: up, down, in parts, cleared, broken off, and by two stations at once."""

from __future__ import annotations

from math import nan
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.mavlink import Endpoint
from tests.vehicle_sim.autopilot.ground_station import HOME, GroundStation, ready
from vehicle_sim.autopilot.plans.item import Item, as_float, as_int, received
from vehicle_sim.autopilot.plans.store import FENCE, KINDS, polygons_closed

ACCEPTED, ERROR, UNSUPPORTED_FRAME, UNSUPPORTED, NO_SPACE, INVALID_SEQUENCE, DENIED, CANCELLED = (
    0,
    1,
    2,
    3,
    4,
    13,
    14,
    15,
)
WAYPOINT, TAKEOFF, JUMP = 16, 22, 177
NEAR = (round(HOME.latitude_deg * 1e7) + 1000, round(HOME.longitude_deg * 1e7) + 1000)
THREE = (Item(WAYPOINT), Item(TAKEOFF, 3, z=10.0), Item(WAYPOINT, 3, x=NEAR[0], y=NEAR[1], z=12.5))
CIRCLE = (Item(5003, 0, 50.0, x=NEAR[0], y=NEAR[1]),)
POLYGON = tuple(Item(5001, 0, 3.0, x=NEAR[0] + 10 * n, y=NEAR[1] + n * n) for n in range(3))
RALLIES = (Item(5100, 3, x=NEAR[0], y=NEAR[1], z=20.0),)


def item_message(item: Item, seq: int, *, floats: bool = False, kind: int = 0) -> Any:
    form = as_float if floats else as_int
    return form(item, to=(3, 1), seq=seq, current=False, kind=kind)


def count(number: int, kind: int = 0) -> Any:
    return dialect.MAVLink_mission_count_message(3, 1, number, kind)


def only(heard: list[Any], *types: str) -> list[Any]:
    return [message for message in heard if message.get_type() in types]


def acks(heard: list[Any]) -> list[int]:
    return [message.type for message in only(heard, "MISSION_ACK")]


def upload(station: GroundStation, items: tuple[Item, ...], *, kind: int = 0, floats: bool = False) -> int:
    """Hand over a plan as a station does: what is asked for, when it is asked for; the final acknowledgement."""
    heard = station.tick(count(len(items), kind))
    for _ in range(len(items)):
        asked = only(heard, "MISSION_REQUEST")
        assert [message.mission_type for message in asked] == [kind]
        heard = station.tick(item_message(items[asked[0].seq], asked[0].seq, floats=floats, kind=kind))
        if acks(heard):
            break
    return acks(heard)[-1]


def download(station: GroundStation, *, kind: int = 0, floats: bool = False) -> list[Item]:
    total = only(station.tick(dialect.MAVLink_mission_request_list_message(3, 1, kind)), "MISSION_COUNT")[0]
    assert total.mission_type == kind
    ask = dialect.MAVLink_mission_request_message if floats else dialect.MAVLink_mission_request_int_message
    items = []
    for seq in range(total.count):
        answer = only(station.tick(ask(3, 1, seq, kind)), "MISSION_ITEM", "MISSION_ITEM_INT")[0]
        assert (answer.get_type() == "MISSION_ITEM", answer.seq, answer.mission_type) == (floats, seq, kind)
        items.append(received(answer))
    return items


@pytest.mark.parametrize("floats", [False, True])
@pytest.mark.parametrize(
    ("kind", "items", "total", "text"),
    [
        (0, THREE, b"MIS_TOTAL", "Flight plan received"),
        (1, CIRCLE + POLYGON, b"FENCE_TOTAL", None),
        (2, RALLIES, b"RALLY_TOTAL", "Rally points received"),
    ],
)
def test_what_goes_up_comes_down(
    kind: int, items: tuple[Item, ...], total: bytes, text: str | None, floats: bool
) -> None:
    station = ready()
    assert upload(station, items, kind=kind, floats=floats) == ACCEPTED
    assert (text is None) or station.texts()[-1] == text
    down = download(station, kind=kind, floats=floats)
    for index, (up, got) in enumerate(zip(items, down, strict=True)):
        if kind == 0 and index == 0:
            continue
        assert got[:6] == up[:6]
        assert (got.x, got.y) == pytest.approx((up.x, up.y), abs=40 if floats else 0)  # a float's degrees
    station.tick(dialect.MAVLink_param_request_read_message(3, 1, total, -1))
    assert station.last("PARAM_VALUE").param_value == len(items)
    assert acks(station.tick(dialect.MAVLink_mission_clear_all_message(3, 1, kind))) == [ACCEPTED]
    assert download(station, kind=kind) == []


def test_item_zero_is_home() -> None:
    station = ready()
    heard = station.tick(dialect.MAVLink_mission_request_int_message(3, 1, 0, 0))
    home = only(heard, "MISSION_ITEM_INT")[0]
    assert (home.command, home.frame) == (WAYPOINT, 0)
    assert (home.x, home.y) == (round(HOME.latitude_deg * 1e7), round(HOME.longitude_deg * 1e7))
    assert home.z == pytest.approx(HOME.altitude_m, abs=1e-3)


def test_beyond_the_end_it_says_how_many_there_are() -> None:
    station = ready()
    upload(station, THREE)
    heard = station.tick(dialect.MAVLink_mission_request_int_message(3, 1, 9, 0))
    assert [message.count for message in only(heard, "MISSION_COUNT")] == [3]
    assert acks(heard) == [ERROR]
    assert acks(station.tick(dialect.MAVLink_mission_request_int_message(3, 1, 9, 2))) == [INVALID_SEQUENCE]


def test_an_upload_asks_again_every_second_and_gives_up_after_eight() -> None:
    station = ready()
    upload(station, THREE)
    station.tick(count(2))
    heard = station.tick(seconds=10.0)
    assert len(only(heard, "MISSION_REQUEST")) == 7
    assert acks(heard) == [CANCELLED]
    assert station.texts()[-1] == "Mission upload timeout"
    assert len(download(station)) == 3  # the old one is still there


def test_a_lost_item_is_asked_for_again() -> None:
    station = ready()
    station.tick(count(2))
    asked = only(station.tick(seconds=1.5), "MISSION_REQUEST")
    assert [message.seq for message in asked] == [0]
    station.tick(item_message(THREE[0], 0))
    assert acks(station.tick(item_message(THREE[0], 0))) == [INVALID_SEQUENCE]  # it came twice: no harm
    assert acks(station.tick(item_message(THREE[1], 1))) == [ACCEPTED]


BAD = [
    (0, (Item(31999),), UNSUPPORTED),
    (0, (Item(WAYPOINT, 9),), UNSUPPORTED_FRAME),
    (0, (Item(WAYPOINT, param1=nan),), 6),
    (0, (Item(WAYPOINT, param3=nan),), 8),
    (0, (Item(WAYPOINT, x=910_000_000),), 10),
    (0, (Item(WAYPOINT, y=-1_810_000_000),), 11),
    (0, (Item(WAYPOINT, z=nan),), 12),
    (0, (Item(WAYPOINT), Item(JUMP, param1=0.0)), ERROR),
    (0, (Item(WAYPOINT), Item(JUMP, param1=7.0)), ERROR),
    (1, (Item(WAYPOINT),), UNSUPPORTED),
    (1, (Item(5003, 0, -1.0),), 6),
    (1, POLYGON[:2], ERROR),
    (2, (Item(WAYPOINT),), UNSUPPORTED),
    (2, (Item(5100, 0),), UNSUPPORTED_FRAME),
]


@pytest.mark.parametrize(("kind", "items", "result"), BAD)
def test_a_bad_item_ends_the_upload(kind: int, items: tuple[Item, ...], result: int) -> None:
    station = ready()
    assert upload(station, items, kind=kind) == result
    assert download(station, kind=kind) == []


@pytest.mark.parametrize("kind", KINDS)
def test_no_more_than_fits(kind: Any) -> None:
    station = ready()
    assert acks(station.tick(count(kind.most + 1, kind.number))) == [NO_SPACE]
    assert station.texts()[-1] == f"Only {kind.most} items are supported"


def test_items_nobody_asked_for_and_plans_nobody_has() -> None:
    station = ready()
    assert acks(station.tick(item_message(THREE[1], 1))) == [ERROR]
    heard = station.tick(dialect.MAVLink_mission_request_list_message(3, 1, 77))
    assert [(ack.type, ack.mission_type) for ack in only(heard, "MISSION_ACK")] == [(UNSUPPORTED, 77)]


def test_two_stations_do_not_mix() -> None:
    station = ready()
    station.tick(count(3))
    other = Endpoint(system_id=250)
    for message in (count(1), item_message(THREE[0], 0), dialect.MAVLink_mission_request_list_message(3, 1, 0)):
        other.send(message)
        reply = Endpoint(system_id=250).receive(station.vehicle.tick(station.now_s, other.take()))
        answers = [(ack.target_system, ack.type) for ack in only(reply, "MISSION_ACK")]
        assert answers == [(250, DENIED)]
    assert acks(station.tick(dialect.MAVLink_mission_clear_all_message(3, 1, 0))) == [ERROR]  # not now
    for seq, item in enumerate(THREE):
        last = station.tick(item_message(item, seq))
    assert acks(last) == [ACCEPTED]


def test_some_items_are_written_anew() -> None:
    station = ready()
    upload(station, THREE)
    heard = station.tick(dialect.MAVLink_mission_write_partial_list_message(3, 1, 2, 3, 0))
    assert [ask.seq for ask in only(heard, "MISSION_REQUEST")] == [2]
    station.tick(item_message(THREE[2]._replace(z=40.0), 2))
    assert acks(station.tick(item_message(Item(20), 3))) == [ACCEPTED]
    assert [item.z for item in download(station)[1:]] == [10.0, 40.0, 0.0]
    for first, last in ((5, 6), (-1, 1), (2, 1)):
        heard = station.tick(dialect.MAVLink_mission_write_partial_list_message(3, 1, first, last, 0))
        assert acks(heard) == [ERROR]


def test_all_plans_are_cleared_at_once() -> None:
    station = ready()
    for kind, items in ((0, THREE), (1, CIRCLE), (2, RALLIES)):
        upload(station, items, kind=kind)
    heard = station.tick(dialect.MAVLink_mission_clear_all_message(3, 1, 255))
    assert [(ack.type, ack.mission_type) for ack in only(heard, "MISSION_ACK")] == [(ACCEPTED, 255)]
    assert [download(station, kind=kind) for kind in (0, 1, 2)] == [[], [], []]


FLOATS = st.floats(width=32, allow_nan=True, allow_infinity=True)
ANY = st.builds(
    Item, st.integers(0, 65535) | st.sampled_from([16, 5001, 5100, 177]), st.integers(0, 255), FLOATS, FLOATS, FLOATS,
    FLOATS, st.integers(-(2**31), 2**31 - 1), st.integers(-(2**31), 2**31 - 1), FLOATS,
)  # fmt: skip


@given(item=ANY, kind=st.sampled_from(KINDS))
def test_any_item_gets_an_answer(item: Item, kind: Any) -> None:
    answer = kind.accepts(item, 3)
    assert 0 <= answer <= 15
    if kind is FENCE and answer == ACCEPTED:
        assert polygons_closed((item,)) in (True, False)


@pytest.mark.parametrize(
    ("items", "closed"),
    [((), True), (CIRCLE, True), (POLYGON + CIRCLE, True), (POLYGON[:2], False), (POLYGON[:2] + CIRCLE, False)],
)
def test_polygons_are_whole(items: tuple[Item, ...], closed: bool) -> None:
    assert polygons_closed(items) is closed


def test_a_reboot_ends_an_upload() -> None:
    station = ready()
    station.tick(dialect.MAVLink_mission_count_message(3, 1, 5, 0))
    assert station.order(246, 1) == 0
    station.tick(seconds=10.0)
    assert "Mission upload timeout" not in station.texts()
    assert len([at_s for at_s, _ in station.all("MISSION_REQUEST")]) == 1
