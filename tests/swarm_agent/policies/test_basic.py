"""B-CMOMMT of section 4.1: help is called for what has left the sight, and helpers fly to the caller."""

from __future__ import annotations

import pytest

from swarm_agent.bcmommt.belief import NEVER, NOBODY, Table, hear_call, hear_mate, hear_position
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.step import Mind, new_mind
from swarm_agent.policies.basic import decide
from tests.swarm_agent.bcmommt.scene import LAST_TICK, NOW, PAPER_WORLD, claim, sense, table

ME = 2


def act(t: Table, now: float = NOW) -> tuple[Mind, float, float]:
    return decide(t, PAPER_WORLD, new_mind(1.0, 0.0), ME, 0.0, 0.0, now, 1, 100)


def was_owned(t: Table, j: int, x: float, y: float) -> None:
    """Until the last tick the agent owned target j, that stands at (x, y)."""
    hear_position(t, j, x, y, 0.0, 0.0, LAST_TICK)
    t.tagged[j] = True


def calls_from(t: Table, mate: int, x: float, y: float, j: int) -> None:
    """A mate at (x, y) calls, having lost target j 100 m away."""
    hear_mate(t, mate, x, y, LAST_TICK)
    hear_position(t, j, x + 100.0, y, 0.0, 0.0, LAST_TICK)
    hear_call(t, PAPER_WORLD, j, mate, LAST_TICK, LAST_TICK)


def test_tags_are_followed_by_their_center_of_gravity() -> None:
    t = table()
    sense(t, 0, 0.3, 0.0)
    sense(t, 1, -0.1, 0.4)
    sense(t, 2, 3.0, 3.0)
    claim(t, 2, 0, 1.0)  # a mate is nearer
    mind, vx, vy = act(t)
    assert mind.mode is Mode.FOLLOW
    assert t.tagged == [True, True, False, False]
    assert (vx, vy) == pytest.approx((0.1, 0.2))


@pytest.mark.parametrize(("distance", "calls"), [(5.4, False), (5.6, True), (6.5, True), (6.7, False)])
def test_help_is_called_from_the_annulus_between_sight_and_predictive_range(distance: float, calls: bool) -> None:
    t = table()
    sense(t, 0, 1.0, 0.0)
    was_owned(t, 1, 0.0, distance)
    act(t)
    assert t.calling == [False, calls, False, False]
    assert not t.tagged[1]


def test_nothing_in_sight_is_called_for_however_many_there_are() -> None:
    t = table()
    for j in range(4):
        sense(t, j, 5.0, 0.2 * j, 0.3, 0.0)
    act(t)
    assert not any(t.calling)


def test_the_call_ends_when_a_mate_has_the_target_or_it_is_back_or_too_old() -> None:
    t = table()
    was_owned(t, 1, 0.0, 6.0)
    act(t)
    assert act(t, NOW + 1.0)[0].helping == 1  # still calling, long after the tag
    assert act(t, NOW + 20.0)[0].helping == NOBODY
    assert act(t)[0].helping == 1
    claim(t, 1, 0, 2.0)
    assert act(t)[0].helping == NOBODY
    assert t.lost_at_s[1] == NEVER

    t = table()
    was_owned(t, 1, 0.0, 6.0)
    act(t)
    sense(t, 1, 0.0, 5.0)
    assert act(t)[0].mode is Mode.FOLLOW
    assert not t.calling[1]


def test_a_target_that_a_mate_was_following_is_none_of_my_losses() -> None:
    t = table()
    hear_position(t, 1, 0.0, 6.0, 0.0, 0.0, LAST_TICK)
    assert act(t)[0].mode is Mode.EXPLORE
    assert not t.calling[1]


def test_who_has_lost_its_last_target_flies_after_the_nearest() -> None:
    t = table()
    calls_from(t, 0, -1.0, 0.0, 3)
    was_owned(t, 0, 6.3, 0.0)
    was_owned(t, 1, 0.0, 6.0)
    mind, vx, vy = act(t)
    assert t.calling[:2] == [True, True]
    assert (mind.mode, mind.helping, mind.capture_s) == (Mode.HELP, 1, 15.0)
    assert (vx, vy) == pytest.approx((0.0, 0.4))


def test_helpers_go_at_once_to_the_nearest_caller_not_to_its_target() -> None:
    t = table()
    calls_from(t, 0, -6.0, 8.0, 3)
    calls_from(t, 4, 0.0, -12.0, 1)
    mind, vx, vy = act(t)
    assert (mind.mode, mind.helping, mind.capture_s) == (Mode.HELP, 3, 25.0)
    assert (vx, vy) == pytest.approx((-0.24, 0.32))
    assert act(t, NOW + 1.0)[0].mode is Mode.EXPLORE  # the call has run out


def test_an_answer_of_another_helper_keeps_nobody_away() -> None:
    t = table()
    calls_from(t, 0, -6.0, 8.0, 3)
    t.answerer[3], t.answer_capture_s[3], t.answerer_at_s[3] = 1, 0.5, LAST_TICK
    assert act(t)[0].helping == 3


def test_a_helper_tags_whatever_it_comes_across() -> None:
    t = table()
    calls_from(t, 0, -6.0, 8.0, 3)
    mind, _, _ = act(t)
    sense(t, 1, 1.0, 0.0)
    mind, vx, vy = decide(t, PAPER_WORLD, mind, ME, 0.0, 0.0, NOW, 1, 101)
    assert (mind.mode, mind.helping) == (Mode.FOLLOW, NOBODY)
    assert (vx, vy) == pytest.approx((0.4, 0.0))
