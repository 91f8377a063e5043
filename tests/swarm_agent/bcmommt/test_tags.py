"""Who owns a target (section 4.1, definition 3), on cases a reader can check by hand."""

from __future__ import annotations

import pytest

from swarm_agent.bcmommt.belief import NOBODY, begin_tick, hear_answer, hear_call, hear_mate, hear_tag
from swarm_agent.bcmommt.tags import claim_tags, nearest_tag
from tests.swarm_agent.bcmommt.scene import LAST_TICK, NOW, PAPER_WORLD, claim, sense, table

P = PAPER_WORLD


def test_every_target_in_sight_that_nobody_claims_is_tagged() -> None:
    t = table()
    sense(t, 0, 3.0, 4.0)
    sense(t, 2, 0.0, 1.0)
    assert claim_tags(t, P, 1, NOBODY, NOW) == 2
    assert t.tagged == [True, False, True, False]
    assert nearest_tag(t) == 2


@pytest.mark.parametrize(
    ("mate", "distance", "mine"),
    [
        (0, 4.999, False),  # the mate is nearer
        (0, 5.001, True),
        (0, 5.0, False),  # equally far: the lower id
        (2, 5.0, True),
    ],
)
def test_the_nearest_owns_and_ties_go_to_the_lower_id(mate: int, distance: float, mine: bool) -> None:
    t = table()
    sense(t, 0, 3.0, 4.0)  # 5 m away
    claim(t, 0, mate, distance)
    claim_tags(t, P, 1, NOBODY, NOW)
    assert t.tagged[0] is mine


def test_a_claim_is_compared_with_my_distance_of_the_same_tick() -> None:
    t = table()
    sense(t, 0, 3.0, 4.0)
    t.distance_before_m[0] = 5.2  # one tick ago I was further away, and the mate, at 5.1, nearer
    claim(t, 0, 4, 5.1)
    claim_tags(t, P, 1, NOBODY, NOW)
    assert not t.tagged[0]


def test_two_agents_with_equal_stamps_never_both_drop_and_never_both_keep() -> None:
    for d_low, d_high in [(2.0, 2.0), (2.0, 2.001), (2.001, 2.0)]:
        kept = []
        for me, mine, other, theirs in [(1, d_low, 3, d_high), (3, d_high, 1, d_low)]:
            t = table()
            sense(t, 0, mine, 0.0)
            claim(t, 0, other, theirs)
            claim_tags(t, P, me, NOBODY, NOW)
            kept.append(t.tagged[0])
        assert sorted(kept) == [False, True]


def test_claims_are_leases() -> None:
    t = table()
    sense(t, 0, 3.0, 4.0)
    claim(t, 0, 0, 1.0, at=NOW - 0.5)
    claim_tags(t, P, 1, NOBODY, NOW)
    assert not t.tagged[0]
    claim_tags(t, P, 1, NOBODY, NOW + 0.1)
    assert t.tagged[0]


def test_a_frame_without_the_tag_withdraws_it_at_once() -> None:
    t = table()
    sense(t, 0, 3.0, 4.0)
    claim(t, 0, 0, 1.0)
    hear_mate(t, 0, 0.0, 0.0, NOW)
    claim_tags(t, P, 1, NOBODY, NOW)
    assert t.tagged[0]


def test_of_two_claims_the_nearer_counts_in_either_order() -> None:
    for order in [((0, 3.0), (2, 2.0)), ((2, 2.0), (0, 3.0))]:
        t = table()
        for mate, distance in order:
            hear_tag(t, P, 0, mate, distance, LAST_TICK)
        assert (t.owner[0], t.owner_distance_m[0]) == (2, 2.0)


def test_a_helper_tags_its_own_target_and_those_that_are_not_safe() -> None:
    t = table()
    for j in range(4):
        sense(t, j, 1.0, float(j))
    claim(t, 0, 3, 4.0)  # its call's target, owned by the caller further away
    claim(t, 1, 3, 4.0)  # owned: safe
    hear_answer(t, P, 2, 4, 1.0, LAST_TICK)  # answered by another: safe
    claim_tags(t, P, 1, 0, NOW)
    assert t.tagged == [True, False, False, True]
    claim_tags(t, P, 1, NOBODY, NOW)
    assert t.tagged == [True, True, True, True]


@pytest.mark.parametrize(("loss_in", "tagged"), [(5.0, False), (0.0, True)])
def test_a_helper_takes_an_answered_target_that_is_lost_already(loss_in: float, tagged: bool) -> None:
    t = table()
    sense(t, 1, 1.0, 0.0)
    hear_call(t, P, 1, 2, LAST_TICK + loss_in, LAST_TICK)
    hear_answer(t, P, 1, 4, 1.0, LAST_TICK)
    claim_tags(t, P, 1, 0, NOW)
    assert t.tagged[1] is tagged


def test_what_was_seen_is_forgotten_but_its_distance_is_kept_for_one_tick() -> None:
    t = table()
    sense(t, 0, 3.0, 4.0)
    begin_tick(t)
    assert not t.sensed[0]
    assert t.distance_before_m[0] == 5.0
    begin_tick(t)
    assert t.distance_before_m[0] > 1000.0
