"""What each flight mode does without a pilot, and with one, in the air of a real ArduCopter's recordings."""

from __future__ import annotations

from math import dist, hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import (
    ALT_HOLD,
    AUTO,
    BRAKE,
    GUIDED,
    LAND,
    LOITER,
    POSHOLD,
    RTL,
    SMART_RTL,
    STABILIZE,
    GroundStation,
    flying,
    position,
    ready,
    velocity,
)
from vehicle_sim.autopilot.ardupilot.modes import MODES, Mode
from vehicle_sim.autopilot.ardupilot.navigation.breadcrumbs import cleaned, pruned, simplified

ACCEPTED, FAILED = 0, 4


def place(station: GroundStation) -> tuple[float, float, float]:
    return station.vehicle.truth.position_ned_m


def test_the_numbers_are_ardupilots() -> None:
    copter = dialect.enums["COPTER_MODE"]
    assert {mode.name: mode.value for mode in Mode} == {
        copter[mode.value].name.removeprefix("COPTER_MODE_"): mode.value for mode in Mode
    }
    assert set(MODES) == set(Mode)


@pytest.mark.parametrize("mode", [STABILIZE, ALT_HOLD, LOITER, POSHOLD])
def test_a_pilots_mode_comes_down_without_a_pilot_and_disarms(mode: int) -> None:
    station = flying()
    assert station.order(176, 1, mode) == ACCEPTED
    while station.vehicle.truth.armed and station.now_s < 60.0:
        station.tick()
    assert station.vehicle.truth.on_ground
    assert not station.vehicle.truth.armed
    assert station.last("HEARTBEAT").custom_mode == mode


@pytest.mark.parametrize("mode", [ALT_HOLD, LOITER, POSHOLD])
def test_it_sinks_at_the_pilots_speed_as_recorded(mode: int) -> None:
    station = flying(altitude_m=30.0)
    station.tick(seconds=15.0)
    station.order(176, 1, mode)
    station.tick(seconds=4.0)
    assert station.vehicle.truth.velocity_ned_m_s[2] == pytest.approx(2.5, abs=0.1)  # PILOT_SPEED_UP; recorded: 2.37
    station.order(176, 1, GUIDED)  # its own limits come back
    for _ in range(30):
        station.tick(velocity(0.0, 0.0, 9.0))
    assert station.vehicle.truth.velocity_ned_m_s[2] == pytest.approx(1.5, abs=0.1)


def test_a_pilot_holds_loiter_up_flies_it_and_lets_go() -> None:
    station = flying()
    hold = dialect.MAVLink_rc_channels_override_message(3, 1, 1500, 1500, 1500, 1500, *[0] * 4)
    forward = dialect.MAVLink_manual_control_message(3, 500, 0, 500, 0, 0)
    station.order(176, 1, LOITER)
    for _ in range(30):
        station.tick(hold)
    assert -place(station)[2] == pytest.approx(10.0, abs=0.3)
    for _ in range(50):
        station.tick(forward)
    assert station.vehicle.truth.velocity_ned_m_s[0] == pytest.approx(6.25, abs=0.3)  # half of LOIT_SPEED
    for _ in range(80):
        station.tick(hold)
    assert hypot(*station.vehicle.truth.velocity_ned_m_s) < 0.1
    station.tick(seconds=20.0)  # nobody at the sticks any more
    assert station.vehicle.truth.on_ground


def test_a_pilot_takes_off_in_loiter() -> None:
    station = ready()
    station.order(176, 1, LOITER)
    assert station.order(400, 1) == ACCEPTED
    for _ in range(50):
        station.tick(dialect.MAVLink_manual_control_message(3, 0, 0, 900, 0, 0))
    assert -place(station)[2] > 4.0
    assert station.last("HEARTBEAT").system_status == 4


@pytest.mark.parametrize(
    ("mode", "navigates", "result"),
    [
        (GUIDED, 0, ACCEPTED),
        (LOITER, 0, ACCEPTED),
        (POSHOLD, 0, ACCEPTED),
        (ALT_HOLD, 0, FAILED),
        (ALT_HOLD, 1, ACCEPTED),
        (STABILIZE, 1, FAILED),
    ],
)
def test_which_modes_take_off(mode: int, navigates: int, result: int) -> None:
    station = ready()
    station.order(176, 1, mode)
    assert station.order(400, 1) == ACCEPTED
    assert station.order(22, 0, 0, navigates, 0, 0, 0, 5.0) == result


@pytest.mark.parametrize("mode", [AUTO, RTL, LAND, BRAKE])
def test_modes_that_do_not_arm(mode: int) -> None:
    assert not MODES[Mode(mode)].armable


def test_brake_stops_and_stays() -> None:
    station = flying()
    for _ in range(60):
        station.tick(velocity(5.0))
    before = place(station)
    station.order(176, 1, BRAKE)
    station.tick(seconds=8.0)
    stopped = place(station)
    assert 2.0 < stopped[0] - before[0] < 15.0
    station.tick(seconds=10.0)
    assert place(station) == pytest.approx(stopped, abs=0.2)


def test_smart_rtl_goes_back_the_way_it_came() -> None:
    """Out round a corner and back: at the corner again, though the straight way home is far from it."""
    station = flying()
    for corner in ((40.0, 0.0, -10.0), (40.0, 40.0, -10.0)):
        station.tick(position(*corner), seconds=15.0)
    assert station.order(176, 1, SMART_RTL) == ACCEPTED
    way = []
    while station.vehicle.truth.armed and station.now_s < 200.0:
        station.tick()
        way.append(place(station))
    assert min(dist(spot, (40.0, 0.0, -10.0)) for spot in way) < 3.0
    assert place(station) == pytest.approx((0.0, 0.0, 0.0), abs=0.6)
    assert station.texts()[-1] == "Disarming motors"


def test_smart_rtl_needs_a_trail() -> None:
    station = ready()
    assert station.order(176, 1, SMART_RTL) == FAILED
    assert station.texts()[-1] == "Mode change to SMART_RTL failed: init failed"


def test_smart_rtl_left_and_entered_again_still_knows_the_way() -> None:
    station = flying()
    for corner in ((40.0, 0.0, -10.0), (40.0, 40.0, -10.0)):
        station.tick(position(*corner), seconds=15.0)
    station.order(176, 1, SMART_RTL)
    station.tick(seconds=2.0)
    station.order(176, 1, GUIDED)
    station.tick(seconds=2.0)
    station.order(176, 1, SMART_RTL)
    nearest_m = 99.0
    while station.vehicle.truth.armed and station.now_s < 200.0:
        station.tick()
        nearest_m = min(nearest_m, dist(place(station), (40.0, 0.0, -10.0)))
    assert nearest_m < 3.0


def test_a_full_trail_is_given_up_with_a_word() -> None:
    station = flying()
    station.tick(dialect.MAVLink_param_set_message(3, 1, b"SRTL_POINTS", 6.0, 4))
    for corner in ((20.0, 0.0), (20.0, 20.0), (40.0, 20.0), (40.0, 40.0), (60.0, 40.0), (60.0, 60.0), (80.0, 60.0)):
        station.tick(position(*corner, -10.0), seconds=12.0)
    assert "SmartRTL deactivated: buffer full" in station.texts()
    assert station.order(176, 1, SMART_RTL) == FAILED


PLACES = st.lists(st.tuples(*[st.floats(-50.0, 50.0)] * 3), min_size=1, max_size=30)


@given(trail=PLACES)
def test_a_simplified_trail_keeps_its_ends_and_stays_near(trail: list[tuple[float, float, float]]) -> None:
    result = simplified(trail, beside_m=1.0)
    assert (result[0], result[-1]) == (trail[0], trail[-1])
    assert set(result) <= set(trail)


@given(trail=PLACES)
def test_a_pruned_trail_begins_at_home_and_never_comes_back_to_itself(trail: list[tuple[float, float, float]]) -> None:
    result = pruned(trail, near_m=2.0)
    assert result[0] == trail[0]
    for index, spot in enumerate(result):
        assert all(dist(spot, later) > 2.0 for later in result[index + 1 :])


def test_a_line_becomes_its_ends_and_a_loop_is_cut() -> None:
    line = [(2.0 * k, 0.0, -5.0) for k in range(20)]
    assert simplified(line, beside_m=1.0) == [line[0], line[-1]]
    assert cleaned(line, accuracy_m=-2.0) == [line[0], line[-1]]  # SRTL_ACCURACY can be anything
    loop = [(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 10.0, 0.0), (0.5, 0.5, 0.0), (-10.0, 0.0, 0.0)]
    assert pruned(loop, near_m=2.0) == [loop[0], loop[-1]]
