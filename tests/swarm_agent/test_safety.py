"""Safety, as laws: nothing changes where nothing is near; and whoever flies what is allowed never comes too far."""

from __future__ import annotations

from math import cos, hypot, inf, isfinite, nan, sin, tau

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from comms.messages import Frame
from comms.status import Level
from swarm_agent.fence import Fence, circle, encloses, polygon
from swarm_agent.safety import MEMORY_S, Guard, Limit, SafetyConfig, nearest_allowed, stopping_distance_m
from tests.examples import FEW

TICK_S = 0.1
ACCELERATION_M_S2 = 2.5
FASTEST_M_S = 8.0
SEPARATION_M = 2.0
COMB = polygon([(-40, -10), (60, -10), (60, 80), (40, 80), (40, 10), (20, 10), (20, 50), (-40, 50)])
SQUARE = polygon([(60.0, 60.0), (-60.0, 60.0), (-60.0, -60.0), (60.0, -60.0)])
ANGLE = polygon([(-60.0, -60.0), (60.0, -60.0), (60.0, 10.0), (10.0, 10.0), (10.0, 60.0), (-60.0, 60.0)])
STILL = (0.0, 0.0, 0.0)
SPEEDS = st.tuples(st.floats(-6.0, 6.0), st.floats(-5.0, 5.0))


def guard(uid: int = 0, fence: Fence = SQUARE, separation_m: float = SEPARATION_M) -> Guard:
    return Guard(
        SafetyConfig(
            uid=uid,
            fence=fence,
            separation_m=separation_m,
            max_speed_m_s=FASTEST_M_S,
            acceleration_m_s2=ACCELERATION_M_S2,
        )
    )


class Drone:
    """A vehicle that follows setpoints with inertia, as late as the recorded ArduCopter does."""

    def __init__(self, uid: int, x: float, y: float, fence: Fence = SQUARE) -> None:
        self.uid = uid
        self.guard = guard(uid, fence)
        self.place, self.speed = [x, y], [0.0, 0.0]
        self._asked = [(0.0, 0.0)] * 4  # on their way

    def frame(self, now_s: float) -> Frame:
        x, y = self.place
        return Frame(self.uid, 1, now_s, 1.0, (x, y, 10.0), (self.speed[0], self.speed[1], 0.0))

    def fly(self, now_s: float, wish: tuple[float, float], inbox: list[Frame]) -> tuple[float, float]:
        self.guard.hear(now_s, inbox)
        safe = self.guard.safe(now_s, (self.place[0], self.place[1], 10.0), (self.speed[0], self.speed[1], 0.0), wish)
        self._asked.append(safe)
        want = self._asked.pop(0)
        for axis in (0, 1):
            most = ACCELERATION_M_S2 * TICK_S / 1.42  # both axes together stay within the acceleration
            self.speed[axis] += min(max(want[axis] - self.speed[axis], -most), most)
            self.place[axis] += self.speed[axis] * TICK_S
        return safe


@given(SPEEDS, st.tuples(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0)))
def test_far_from_everything_the_wish_is_flown_to_the_last_bit(
    wish: tuple[float, float], place: tuple[float, float]
) -> None:
    mine = guard()
    mine.hear(0.0, [Frame(1, 1, 0.0, 1.0, (place[0], place[1], 12.0), (0.0, 0.0, 0.0))])  # another layer
    assert mine.safe(0.0, (*place, 10.0), (*wish, 0.0), wish) is wish


@pytest.mark.parametrize("fence", [SQUARE, ANGLE, COMB, circle(60.0)], ids=["square", "angle", "comb", "circle"])
@FEW
@given(wishes=st.lists(SPEEDS, min_size=1, max_size=6))
@example(wishes=[(0.0, -4.75), (0.0, 1.5), (-6.0, 0.0)])  # who turns does not brake
def test_no_wish_leads_out_of_the_fence(fence: Fence, wishes: list[tuple[float, float]]) -> None:
    drone = Drone(0, -5.0, -5.0, fence)
    for tick in range(400):
        drone.fly(tick * TICK_S, wishes[tick // 70 % len(wishes)], [])
        assert encloses(fence.corners_m, *drone.place)


def test_who_comes_back_from_other_hands_begins_from_how_it_flies() -> None:
    mine = guard()
    assert mine.safe(0.0, (50.0, 0.0, 10.0), (1.0, 4.0, 0.0), (6.0, 4.0))[1] == pytest.approx(4.0)
    assert mine.safe(0.1, (50.0, 0.0, 10.0), STILL, (0.0, 0.0))[1] > 3.5  # no faster than it can be turned
    assert mine.safe(9.0, (50.0, 0.0, 10.0), STILL, (0.0, 0.0)) == (0.0, 0.0)


@FEW
@given(
    corners=st.lists(st.tuples(st.floats(0.0, tau), st.floats(5.0, 70.0)), min_size=3, max_size=9),
    wishes=st.lists(SPEEDS, min_size=1, max_size=6),
)
def test_no_wish_leads_out_of_any_fence(corners: list[tuple[float, float]], wishes: list[tuple[float, float]]) -> None:
    """However acute its corners are, and whichever way it bends."""
    fence = polygon([(radius_m * cos(angle), radius_m * sin(angle)) for angle, radius_m in sorted(corners)])
    assume(fence.core_m > 1.0)
    drone = Drone(0, 0.0, 0.0, fence)
    for tick in range(300):
        drone.fly(tick * TICK_S, wishes[tick // 30 % len(wishes)], [])
        assert encloses(fence.corners_m, *drone.place)


def test_a_wall_that_stands_elsewhere_is_not_in_the_way() -> None:
    """In the longer leg of the comb it flies past the height at which the shorter one ends."""
    drone = Drone(0, 50.0, 20.0, COMB)
    for tick in range(400):
        drone.fly(tick * TICK_S, (0.0, 6.0), [])
    assert 75.0 < drone.place[1] < 80.0


def test_a_wall_is_flown_along_at_full_speed() -> None:
    drone = Drone(0, -50.0, 57.0, SQUARE)
    for tick in range(80):
        drone.fly(tick * TICK_S, (6.0, 6.0), [])
    assert drone.speed[0] == pytest.approx(6.0, abs=0.01)


@FEW
@given(wishes=st.lists(SPEEDS, min_size=4, max_size=4))
def test_no_wish_brings_mates_together(wishes: list[tuple[float, float]]) -> None:
    drones = [Drone(uid, 12.0 * uid - 18.0, 3.0 * uid) for uid in range(4)]
    frames: list[Frame] = []
    for tick in range(400):
        now_s = tick * TICK_S
        heard, frames = frames, [drone.frame(now_s) for drone in drones]
        for drone, wish in zip(drones, wishes, strict=True):
            drone.fly(now_s, wish, [frame for frame in heard if frame.src != drone.uid])
        for drone in drones:
            for other in drones[: drone.uid]:
                assert hypot(drone.place[0] - other.place[0], drone.place[1] - other.place[1]) > 0.75 * SEPARATION_M


def test_mates_that_meet_head_on_get_past_each_other() -> None:
    west, east = Drone(0, -15.0, 0.0), Drone(1, 15.0, 0.0)
    frames: list[Frame] = []
    for tick in range(300):
        now_s = tick * TICK_S
        heard, frames = frames, [west.frame(now_s), east.frame(now_s)]
        west.fly(now_s, (3.0, 0.0), heard[1:])
        east.fly(now_s, (-3.0, 0.0), heard[:1])
    assert west.place[0] > 10.0
    assert east.place[0] < -10.0


def test_mates_in_one_place_part() -> None:
    here = (0.0, 0.0, 10.0)
    velocities = []
    for uid in (0, 1):
        mine = guard(uid)
        mine.hear(0.0, [Frame(1 - uid, 1, 0.0, 1.0, here, (0.0, 0.0, 0.0))])
        velocities.append(mine.safe(0.0, here, STILL, (0.0, 0.0)))
    assert velocities[0][0] > 0.2
    assert velocities[1][0] < -0.2


def test_a_mate_that_falls_silent_is_expected_on_its_way_and_then_forgotten() -> None:
    mine = guard()
    mine.hear(0.0, [Frame(1, 1, 0.0, 1.0, (10.0, 0.0, 10.0), (-4.0, 0.0, 0.0))])
    assert mine.safe(0.0, (0.0, 0.0, 10.0), (0.5, 0.0, 0.0), (0.5, 0.0)) == (0.5, 0.0)
    assert mine.safe(1.5, (0.0, 0.0, 10.0), (0.5, 0.0, 0.0), (0.5, 0.0))[0] < 0.5  # it should be 4 m away by now
    mine.hear(MEMORY_S + 0.1, [])
    assert mine.safe(MEMORY_S + 0.1, (0.0, 0.0, 10.0), (1.0, 0.0, 0.0), (1.0, 0.0)) == (1.0, 0.0)


def test_without_a_separation_mates_do_not_matter() -> None:
    mine = guard(separation_m=0.0)
    mine.hear(0.0, [Frame(1, 1, 0.0, 1.0, (0.1, 0.0, 10.0), (0.0, 0.0, 0.0))])
    assert mine.safe(0.0, (0.0, 0.0, 10.0), (5.0, 0.0, 0.0), (5.0, 0.0)) == (5.0, 0.0)


def test_who_is_outside_says_so_once_and_comes_back() -> None:
    mine = guard()
    for now_s in (0.0, 0.1):
        assert mine.safe(now_s, (64.0, 0.0, 10.0), STILL, (5.0, 1.0))[0] == pytest.approx(-2.5)
    (event,) = mine.take_events()
    assert (event.level, event.text) == (Level.ERROR, "4.0 m outside its fence: coming back")
    mine.safe(0.2, (59.0, 0.0, 10.0), STILL, (0.0, 0.0))
    assert [event.text for event in mine.take_events()] == ["inside its fence again"]


@pytest.mark.parametrize("bad", [nan, inf, -inf, 1e308])
def test_numbers_that_are_none_are_never_flown(bad: float) -> None:
    mine = guard()
    frame = Frame(1, 1, 0.0, 1.0, (bad, bad, 10.0), (bad, 0.0, 0.0))
    mine.hear(0.0, [frame, frame._replace(src=2, sent_at_s=bad, position_m=(1.0, 1.0, bad))])
    for position_m, wish in [
        ((bad, 0.0, 10.0), (1.0, 1.0)),
        ((0.0, 0.0, 10.0), (bad, 0.0)),
        ((59.0, 0.0, bad), (5, 5)),
    ]:
        assert all(map(isfinite, mine.safe(0.0, position_m, STILL, wish)))


@given(st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-3.0, 5.0)), max_size=6), SPEEDS)
def test_of_what_is_allowed_the_nearest_to_the_wish(
    rows: list[tuple[float, float, float]], wish: tuple[float, float]
) -> None:
    """Referee: a grid over all velocities holds none that is better."""
    limits = [Limit(x / hypot(x, y), y / hypot(x, y), speed) for x, y, speed in rows if hypot(x, y) > 0.01]
    chosen = nearest_allowed(wish, limits, max_speed_m_s=FASTEST_M_S)

    def excess(velocity: tuple[float, float]) -> float:
        return max((velocity[0] * n.east + velocity[1] * n.north - n.speed_m_s for n in limits), default=0.0)

    grid = [(east / 4.0, north / 4.0) for east in range(-20, 21) for north in range(-20, 21)]
    allowed = [velocity for velocity in grid if excess(velocity) <= 0.0]
    if allowed:
        assert excess(chosen) <= 1e-6
        nearest_m_s = min(hypot(east - wish[0], north - wish[1]) for east, north in allowed)
        assert hypot(chosen[0] - wish[0], chosen[1] - wish[1]) <= nearest_m_s + 1e-6


def test_the_way_to_stop() -> None:
    assert stopping_distance_m(0.0, 2.5) == 0.0
    assert stopping_distance_m(7.0, 2.5) == pytest.approx(7.0 + 49.0 / 1.75)
