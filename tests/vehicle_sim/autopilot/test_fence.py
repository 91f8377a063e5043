"""Fences and rally points: where a border is, what a crossing does, and where a return leads then."""

from __future__ import annotations

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import (
    BRAKE,
    GUIDED,
    LAND,
    RTL,
    SMART_RTL,
    GroundStation,
    flying,
    position,
    ready,
    velocity,
)
from tests.vehicle_sim.autopilot.test_auto import at
from tests.vehicle_sim.autopilot.test_plans import upload
from vehicle_sim.autopilot.outline import Circle, Outline, Polygon

FENCE_BIT = 0x100000
SQUARE = ((30.0, -30.0), (30.0, 30.0), (-30.0, 30.0), (-30.0, -30.0))


def fenced(station: GroundStation, **parameters: float) -> GroundStation:
    for name, value in {"FENCE_ENABLE": 1, **parameters}.items():
        station.tick(dialect.MAVLink_param_set_message(3, 1, name.encode(), value, 9))
    return station


def mode_after(station: GroundStation, *, north: float = 5.0, down: float = 0.0, seconds: float = 25.0) -> int:
    """Fly that way until the mode changes, or for `seconds`; the mode then."""
    for _ in range(round(seconds * 10)):
        station.tick(velocity(north, 0.0, down))
        if station.last("HEARTBEAT").custom_mode != GUIDED:
            break
    return int(station.last("HEARTBEAT").custom_mode)


def test_a_place_beyond_a_fence_is_not_flown_to() -> None:
    station = flying()
    assert upload(station, tuple(at(*corner, 0.0, 5001, param1=4.0) for corner in SQUARE), kind=1) == 0
    fenced(station, FENCE_TYPE=7, FENCE_ALT_MAX=20, FENCE_RADIUS=100)
    station.tick(position(10.0, 0.0, -10.0), seconds=8.0)
    for beyond in (position(40.0, 0.0, -10.0), position(10.0, 0.0, -25.0)):
        station.tick(beyond, seconds=8.0)
        assert station.vehicle.truth.position_ned_m == pytest.approx((10.0, 0.0, -10.0), abs=0.2)
    station.tick(position(20.0, 0.0, -15.0), seconds=15.0)
    assert station.vehicle.truth.position_ned_m[0] == pytest.approx(20.0, abs=0.2)


@pytest.mark.parametrize(
    ("parameters", "mode", "text"),
    [
        ({"FENCE_TYPE": 2, "FENCE_RADIUS": 30, "FENCE_ACTION": 1}, RTL, "Circle fence breached"),
        ({"FENCE_TYPE": 2, "FENCE_RADIUS": 30, "FENCE_ACTION": 2}, LAND, "Circle fence breached"),
        ({"FENCE_TYPE": 2, "FENCE_RADIUS": 30, "FENCE_ACTION": 3}, SMART_RTL, "Circle fence breached"),
        ({"FENCE_TYPE": 2, "FENCE_RADIUS": 30, "FENCE_ACTION": 4}, BRAKE, "Circle fence breached"),
        ({"FENCE_TYPE": 2, "FENCE_RADIUS": 30, "FENCE_ACTION": 5}, SMART_RTL, "Circle fence breached"),
        ({"FENCE_TYPE": 2, "FENCE_RADIUS": 30, "FENCE_ACTION": 0}, GUIDED, "Circle fence breached"),
        ({"FENCE_TYPE": 1, "FENCE_RADIUS": 30}, GUIDED, None),
        ({"FENCE_TYPE": 0}, GUIDED, None),
    ],
)
def test_a_circle_acts_as_told(parameters: dict[str, float], mode: int, text: str | None) -> None:
    station = fenced(flying(), **parameters)
    assert mode_after(station, seconds=9.0) == mode
    assert [said for said in station.texts() if "fence" in said] == ([text] if text else [])


def test_a_ceiling_and_its_status() -> None:
    station = fenced(flying(), FENCE_ALT_MAX=20, FENCE_TYPE=1)
    station.stream(1, 162)
    assert station.last("SYS_STATUS").onboard_control_sensors_health & FENCE_BIT
    assert station.last("FENCE_STATUS").breach_status == 0
    assert mode_after(station, north=0.0, down=-2.0) == RTL
    station.tick()
    assert "Max Alt fence breached" in station.texts()
    status = station.last("FENCE_STATUS")
    assert (status.breach_status, status.breach_count, status.breach_type) == (1, 1, 2)
    assert not station.last("SYS_STATUS").onboard_control_sensors_health & FENCE_BIT
    assert station.last("SYS_STATUS").onboard_control_sensors_enabled & FENCE_BIT
    while station.vehicle.truth.armed and station.now_s < 120.0:
        station.tick()
    assert "Fence breach cleared" in station.texts()
    assert station.last("FENCE_STATUS").breach_status == 0


@pytest.mark.parametrize("inclusion", [True, False])
def test_an_uploaded_polygon(inclusion: bool) -> None:
    """Out of a square around home, or into one in the north."""
    shift = 0.0 if inclusion else 50.0
    corners = tuple(at(n + shift, e, 0, 5001 if inclusion else 5002, param1=4) for n, e in SQUARE)
    station = fenced(flying(), FENCE_TYPE=4)
    assert upload(station, corners, kind=1) == 0
    assert mode_after(station) == RTL
    assert station.vehicle.truth.position_ned_m[0] == pytest.approx(30.0 if inclusion else 20.0, abs=1.0)
    assert "Polygon fence breached" in station.texts()


def test_far_out_it_lands_where_it_is() -> None:
    station = flying()
    station.tick(position(150.0, 0.0, -10.0), seconds=30.0)
    fenced(station, FENCE_TYPE=2, FENCE_RADIUS=30)
    station.tick(seconds=0.5)
    assert station.last("HEARTBEAT").custom_mode == LAND


def test_a_pilot_who_takes_over_is_let_and_a_breach_counts_again_further_out() -> None:
    station = fenced(flying(), FENCE_TYPE=2, FENCE_RADIUS=30)
    assert mode_after(station) == RTL
    assert station.order(176, 1, GUIDED) == 0
    assert mode_after(station, north=0.0, seconds=12.0) == GUIDED
    assert mode_after(station, north=5.0) == RTL
    assert station.vehicle.truth.position_ned_m[0] > 50.0  # 20 m further than the first time
    assert station.texts().count("Circle fence breached") == 2


def test_a_fence_is_switched_by_command_and_acts_only_then() -> None:
    station = flying()
    station.tick(position(170.0, 0.0, -10.0), seconds=30.0)
    assert station.last("HEARTBEAT").custom_mode == GUIDED
    assert station.order(207, 1) == 0
    station.tick(seconds=0.5)
    assert station.last("HEARTBEAT").custom_mode == RTL
    assert station.order(207, 0) == 0
    assert station.order(207, 9) == 4


def test_a_return_stays_below_the_ceiling() -> None:
    station = flying()
    station.tick(position(30.0, 0.0, -10.0), seconds=12.0)
    fenced(station, FENCE_TYPE=1, FENCE_ALT_MAX=14)
    station.order(20)
    station.tick(seconds=8.0)
    assert -station.vehicle.truth.position_ned_m[2] == pytest.approx(12.0, abs=0.4)  # FENCE_MARGIN below


@pytest.mark.parametrize(("north", "goal"), [(40.0, 50.0), (10.0, 0.0)])
def test_a_return_leads_to_the_nearest_rally_point(north: float, goal: float) -> None:
    station = flying()
    assert upload(station, (at(50, 0, 20, 5100), at(900, 0, 20, 5100)), kind=2) == 0
    station.tick(position(north, 0.0, -10.0), seconds=15.0)
    station.order(20)
    while station.vehicle.truth.armed and station.now_s < 150.0:
        station.tick()
    assert station.vehicle.truth.position_ned_m[0] == pytest.approx(goal, abs=0.6)


def test_it_will_not_arm_outside() -> None:
    station = fenced(ready(), FENCE_TYPE=4)
    corners = tuple(at(n + 100.0, e, 0, 5001, param1=4) for n, e in SQUARE)
    upload(station, corners, kind=1)
    assert station.order(400, 1) == 4
    assert station.texts()[-1] == "Arm: vehicle outside Polygon fence"


@given(turn=st.floats(0.0, 6.28), size=st.floats(5.0, 500.0), corners=st.integers(3, 12))
def test_a_polygon_holds_its_middle_and_nothing_beyond_its_corners(turn: float, size: float, corners: int) -> None:
    ring = [turn + 2.0 * pi * n / corners for n in range(corners)]
    polygon = Polygon(tuple((size * cos(a), size * sin(a)) for a in ring))
    assert polygon.holds((0.0, 0.0))
    assert not any(polygon.holds((1.01 * size * cos(a), 1.01 * size * sin(a))) for a in ring)


def test_inside_every_inclusion_and_outside_every_exclusion() -> None:
    both = Outline((Polygon(SQUARE), Circle((0.0, 20.0), 20.0)), (Circle((0.0, 10.0), 5.0),))
    assert both.allows(0.0, 20.0)
    assert not both.allows(0.0, -5.0)  # in one of two
    assert not both.allows(0.0, 10.0)  # in the hole
    assert Outline().allows(1e6, 1e6)


def test_a_reboot_forgets_the_breaches() -> None:
    station = fenced(flying(), FENCE_TYPE=2, FENCE_RADIUS=20, FENCE_ACTION=2)
    assert mode_after(station) == LAND
    while station.vehicle.truth.armed:
        station.tick()
    station.stream(162)
    station.tick()
    assert station.last("FENCE_STATUS").breach_count == 1
    assert station.order(246, 1) == 0
    station.tick(seconds=3.0)
    station.stream(162)
    fenced(station, FENCE_RADIUS=1000)
    station.tick()
    assert station.last("FENCE_STATUS").breach_count == 0
