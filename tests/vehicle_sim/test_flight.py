"""Laws of motion, and the step responses of a recorded ArduCopter 4.5.5 SITL."""

from __future__ import annotations

from itertools import pairwise
from math import atan, cos, degrees, hypot, tan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import FEW
from vehicle_sim.battery import Battery, Charge
from vehicle_sim.flight import GRAVITY_M_S2, Airframe, Demand, FlightLimits, Multirotor

STEP_S = 0.05
CALM = (0.0, 0.0)
LIMITS = FlightLimits()


def airborne(limits: FlightLimits = LIMITS, *, yaw_rad: float = 0.0) -> Multirotor:
    frame = Multirotor(limits=limits, yaw_rad=yaw_rad)
    frame.on_ground = False
    frame.down_m = -500.0
    return frame


def fly(frame: Airframe, demand: Demand | None, seconds: float, air: tuple[float, float] = CALM) -> list[float]:
    """The north velocity after each step."""
    trace = []
    for _ in range(round(seconds / STEP_S)):
        frame.step(STEP_S, demand, air)
        trace.append(frame.north_m_s)
    return trace


def at(trace: list[float], seconds: float) -> float:
    return trace[round(seconds / STEP_S) - 1]


def test_step_to_3_m_s_as_recorded() -> None:
    trace = fly(airborne(), Demand(north_m_s=3.0), 4.0)
    for seconds, recorded in ((0.5, 0.41), (1.0, 1.73), (1.5, 2.57), (2.0, 2.80), (3.0, 2.94), (4.0, 3.0)):
        assert at(trace, seconds) == pytest.approx(recorded, abs=0.15), seconds


def test_step_to_the_speed_limit_as_recorded() -> None:
    trace = fly(airborne(), Demand(north_m_s=15.0), 8.0)
    for seconds, recorded in ((1.0, 1.68), (2.0, 4.12), (3.0, 6.52), (4.0, 8.46), (5.0, 9.43), (6.0, 9.9)):
        assert at(trace, seconds) == pytest.approx(recorded, abs=0.3), seconds
    assert max(trace) <= LIMITS.speed_m_s


def test_stopping_from_3_m_s_takes_the_recorded_way() -> None:
    frame = airborne()
    fly(frame, Demand(north_m_s=3.0), 10.0)
    began_m = frame.north_m
    fly(frame, Demand(), 6.0)
    assert frame.north_m - began_m == pytest.approx(2.66, abs=0.25)


def test_level_3_m_s_leans_as_recorded() -> None:
    frame = airborne()
    fly(frame, Demand(north_m_s=3.0), 10.0)
    roll, pitch = frame.attitude_rad
    assert pitch == pytest.approx(-0.1, abs=0.01)
    assert roll == 0.0


def test_lean_turns_with_the_nose() -> None:
    """Flying north with the nose east is flying to the left: a left lean."""
    frame = airborne(yaw_rad=1.5707963267948966)
    fly(frame, Demand(north_m_s=3.0), 10.0)
    roll, pitch = frame.attitude_rad
    assert roll == pytest.approx(-0.1, abs=0.01)
    assert pitch == pytest.approx(0.0, abs=1e-9)


velocities = st.tuples(*[st.floats(-30.0, 30.0)] * 3)
limits = st.builds(
    FlightLimits,
    speed_m_s=st.floats(1.0, 25.0),
    acceleration_m_s2=st.floats(0.5, 8.0),
    climb_m_s=st.floats(0.3, 8.0),
    descent_m_s=st.floats(0.3, 5.0),
    tilt_deg=st.floats(10.0, 60.0),
)


TURNING = 1.07  # straight on it keeps its speed limit to 2 %; a random search for the worst turn came to 1.053


@given(limits=limits, demands=st.lists(velocities, min_size=1, max_size=6))
def test_calm_air_limits_hold_whatever_is_demanded(limits: FlightLimits, demands: list[tuple[float, ...]]) -> None:
    frame = airborne(limits)
    for demand in demands:
        for _ in range(30):
            before = (frame.north_m_s, frame.east_m_s)
            frame.step(STEP_S, Demand(*demand), CALM)
            assert hypot(frame.north_m_s, frame.east_m_s) <= TURNING * limits.speed_m_s
            assert -1.2 * limits.climb_m_s - 0.3 <= frame.down_m_s <= 1.2 * limits.descent_m_s + 0.3
            lean = degrees(atan(hypot(*frame.lean_ne_m_s2) / GRAVITY_M_S2))
            assert lean <= limits.tilt_deg + 1e-9
            change = hypot(frame.north_m_s - before[0], frame.east_m_s - before[1])
            if lean < limits.tilt_deg - 1e-6:  # at full tilt, drag alone may slow it more
                assert change <= limits.acceleration_m_s2 * STEP_S * (1.0 + 1e-9)
            roll, pitch = frame.attitude_rad
            assert hypot(tan(pitch), tan(roll) / cos(pitch)) * GRAVITY_M_S2 == pytest.approx(
                hypot(*frame.lean_ne_m_s2), abs=1e-9
            )


@given(speed=st.floats(1.0, 25.0), tilt=st.floats(10.0, 60.0))
def test_the_tilt_limit_carries_the_speed_limit(speed: float, tilt: float) -> None:
    frame = airborne(FlightLimits(speed_m_s=speed, tilt_deg=tilt))
    fly(frame, Demand(north_m_s=speed), 120.0)
    assert frame.north_m_s == pytest.approx(speed, rel=0.02)


@FEW
@given(velocity=velocities)
def test_mirrored_demands_give_mirrored_flights(velocity: tuple[float, float, float]) -> None:
    north, east, down = velocity
    one, other = airborne(), airborne()
    fly(one, Demand(north, east, down), 3.0)
    fly(other, Demand(-north, -east, down), 3.0)
    assert (one.north_m, one.east_m) == pytest.approx((-other.north_m, -other.east_m), abs=1e-9)
    assert one.down_m == pytest.approx(other.down_m)


def test_steady_wind_is_leaned_into_and_does_not_carry_it_away() -> None:
    frame = Multirotor(limits=LIMITS, yaw_rad=0.0, trimmed_ne_m_s=(-8.0, 0.0))
    frame.on_ground = False
    frame.down_m = -10.0
    fly(frame, Demand(), 20.0, air=(-8.0, 0.0))
    assert abs(frame.north_m) < 0.2  # recorded in 8 m/s of wind
    assert frame.attitude_rad[1] < -0.2  # nose down, into the north wind


def test_a_gust_pushes_and_is_recovered_from() -> None:
    frame = airborne()
    fly(frame, Demand(), 1.0, air=(0.0, 4.0))
    assert frame.east_m_s > 0.1
    fly(frame, Demand(), 20.0)
    assert abs(frame.east_m_s) < 0.01
    assert abs(frame.east_m) < 3.0


def test_ideal_follows_each_demand_exactly() -> None:
    frame = Airframe(limits=LIMITS, yaw_rad=0.0)
    frame.step(0.1, Demand(3.0, -4.0, -1.0), (9.0, 9.0))
    assert (frame.north_m_s, frame.east_m_s, frame.down_m_s) == (3.0, -4.0, -1.0)
    assert (frame.north_m, frame.east_m, frame.down_m) == pytest.approx((0.3, -0.4, -0.1))
    assert frame.attitude_rad == (0.0, 0.0)


@pytest.mark.parametrize("frame", [Airframe(limits=LIMITS, yaw_rad=0.0), Multirotor(limits=LIMITS, yaw_rad=0.0)])
def test_nothing_sinks_into_the_ground(frame: Airframe) -> None:
    fly(frame, Demand(1.0, 1.0, 1.0), 2.0)
    assert (frame.north_m, frame.east_m, frame.down_m, frame.on_ground) == (0.0, 0.0, 0.0, True)
    fly(frame, Demand(down_m_s=-1.0), 3.0)
    assert frame.down_m < -1.0
    assert not frame.on_ground
    impacts = []
    for _ in range(100):
        frame.step(STEP_S, Demand(down_m_s=1.0), CALM)
        impacts.append(frame.impact_m_s)
    assert (frame.down_m, frame.down_m_s, frame.on_ground) == (0.0, 0.0, True)
    assert [impact for impact in impacts if impact is not None] == [pytest.approx(1.0, abs=0.05)]


def test_a_fall_from_ten_meters_hits_as_hard_as_recorded() -> None:
    frame = airborne()
    frame.down_m = -10.0
    while not frame.on_ground:
        frame.step(STEP_S, None, CALM)
    assert frame.impact_m_s == pytest.approx(11.75, abs=0.8)


def test_hovering_takes_the_hover_current_and_climbing_more() -> None:
    charge, frame = Charge(Battery(capacity_mah=5000.0, hover_current_a=28.0)), airborne()
    fly(frame, Demand(), 1.0)
    for _ in range(600):
        charge.drain(effort=frame.effort, dt_s=0.1)
    assert charge.current_a == pytest.approx(28.0)
    assert charge.consumed_mah == pytest.approx(28.0 * 60.0 / 3.6)  # A s to mAh
    fly(frame, Demand(5.0, 0.0, -2.0), 0.5)
    assert frame.effort > 1.0


def test_out_of_control_it_tumbles_and_falls_until_it_lies_on_the_ground() -> None:
    frame = airborne()
    frame.down_m = -20.0
    frame.uncontrolled = True
    for _ in range(100):
        frame.step(STEP_S, Demand(down_m_s=-1.0), CALM)
        assert frame.tumbling
    assert frame.on_ground
    roll, pitch = frame.attitude_rad
    assert cos(roll) * cos(pitch) < 0.1  # on its side or its back
    frame.uncontrolled = False
    frame.step(STEP_S, None, CALM)
    assert (frame.tumbling, frame.attitude_rad) == (False, (0.0, 0.0))


def test_level_flight_leaves_the_way_to_drag_and_wind() -> None:
    frame = airborne()
    fly(frame, Demand(north_m_s=3.0), 10.0)
    slower = fly(frame, Demand(level=True), 10.0)
    assert all(b < a for a, b in pairwise(slower))
    assert frame.attitude_rad == pytest.approx((0.0, 0.0), abs=1e-3)
    # Recorded when the estimate was lost: from 1.19 to .81 m/s in 2.2 s.
    assert at(slower, 5.7) / at(slower, 3.5) == pytest.approx(0.81 / 1.19, abs=0.15)


@pytest.mark.parametrize("wrong", [{"speed_m_s": 0.0}, {"climb_m_s": float("nan")}, {"tilt_deg": 90.0}])
def test_impossible_limits_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=r"limits\."):
        FlightLimits(**wrong)
