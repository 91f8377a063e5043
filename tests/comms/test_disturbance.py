"""What a disturbance does to a link: the same both ways, apart from who is named, and as much as is said."""

from __future__ import annotations

from itertools import permutations

import pytest

from comms.disturbance import CALM, Disturbance, Trouble

AGENTS = range(6)
LINKS = list(permutations(AGENTS, 2))


def cut(disturbance: Disturbance, tick: int = 0, seed: int = 1) -> set[tuple[int, int]]:
    return {link for link in LINKS if disturbance.of(tick, *link, seed=seed)[0] == 1.0}


def test_where_it_is_calm_nothing_is_lost_or_late() -> None:
    assert {CALM.of(tick, *link, seed=7) for tick in range(50) for link in LINKS} == {(0.0, 0.0)}


def test_a_dead_radio_neither_hears_nor_is_heard() -> None:
    assert cut(Disturbance(silent=frozenset({2}))) == {link for link in LINKS if 2 in link}


def test_groups_hear_themselves_alone_and_who_is_in_none_hears_nobody() -> None:
    halves = Disturbance(partitions=({0: 0, 1: 0, 2: 1, 3: 1, 4: 1},))
    together = {frozenset(pair) for pair in ((0, 1), (2, 3), (2, 4), (3, 4))}
    assert cut(halves) == {link for link in LINKS if frozenset(link) not in together}


def test_two_partitions_leave_what_both_leave() -> None:
    both = Disturbance(partitions=(dict.fromkeys((0, 1, 2), 0), {0: 0, 1: 0, 2: 1, 3: 1, 4: 1, 5: 1}))
    assert cut(both) == set(LINKS) - {(0, 1), (1, 0)}


def test_losses_add_up_as_chances_do_and_latencies_as_times() -> None:
    mine = frozenset({3})
    twice = Disturbance(loss=(Trouble(0.5), Trouble(0.5, mine)), latency=(Trouble(0.2), Trouble(0.3, mine)))
    assert twice.of(0, 0, 1, seed=1) == pytest.approx((0.5, 0.2))
    assert twice.of(0, 0, 3, seed=1) == twice.of(0, 3, 0, seed=1) == pytest.approx((0.75, 0.5))


def test_bursts_take_their_share_of_the_time_in_whole_stretches_and_links_fail_apart() -> None:
    bursts, ticks = Disturbance(bursts=(Trouble(0.3, ticks=20),)), 20 * 400
    down = [cut(bursts, tick) for tick in range(0, ticks, 20)]
    for link in LINKS:
        assert sum(link in gone for gone in down) / len(down) == pytest.approx(0.3, abs=0.1)
        assert [link in gone for gone in down] == [link[::-1] in gone for gone in down]
    assert all(cut(bursts, tick) == cut(bursts, tick - tick % 20) for tick in range(7, 200, 13))
    assert len({frozenset(gone) for gone in down}) > len(down) // 2
    assert [cut(bursts, tick, seed=2) for tick in range(0, 2000, 20)] != down[:100]
