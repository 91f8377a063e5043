"""Laws of cutting up a study: shards share out its units, blocks fly each of them once, and nothing twice."""

from __future__ import annotations

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from missions.load import load_mission
from missions.mission import Mission
from missions.study.points import Point
from missions.study.shards import Shard, blocks

BASE = load_mission("quickstart")


def mission(agents: int) -> Mission:
    return BASE.model_copy(update={"agents": BASE.agents.model_copy(update={"count": agents})})


POINTS = [Point(number, (("agents.count", number + 1),), mission(number + 1)) for number in range(6)]
Units = list[tuple[int, int]]


def units(points: list[Point], seeds: range, shard: Shard, done: dict[str, set[int]], at_most: int = 50) -> Units:
    cut = list(blocks(points, seeds, shard=shard, done=done, at_most=at_most))
    assert all(0 < len(block.seeds) <= at_most for block in cut)
    return [(block.point.number, seed) for block in cut for seed in block.seeds]


sizes = st.tuples(st.integers(1, 6), st.integers(1, 40), st.integers(0, 1000))


@given(sizes, st.integers(1, 12), st.integers(1, 9))
def test_shards_share_out_all_units(size: tuple[int, int, int], count: int, at_most: int) -> None:
    points, seeds = POINTS[: size[0]], range(size[2], size[2] + size[1])
    shares = [units(points, seeds, Shard(index, count), {}, at_most) for index in range(1, count + 1)]
    every = Counter(unit for share in shares for unit in share)
    assert every == Counter((point.number, seed) for point in points for seed in seeds)
    # Of every point each shard has as many runs as any other, give or take one.
    for point in points:
        runs = [sum(number == point.number for number, _ in share) for share in shares]
        assert max(runs) - min(runs) <= 1


@given(sizes, st.integers(1, 5), st.sets(st.integers(0, 239)))
def test_what_is_done_is_not_flown_again(size: tuple[int, int, int], count: int, flown: set[int]) -> None:
    points, seeds = POINTS[: size[0]], range(size[2], size[2] + size[1])
    every = [(point.number, seed) for point in points for seed in seeds]
    done = {unit for place, unit in enumerate(every) if place in flown}
    by_digest = {point.digest: {seed for number, seed in done if number == point.number} for point in points}
    left = [unit for i in range(1, count + 1) for unit in units(points, seeds, Shard(i, count), by_digest)]
    assert sorted(left) == sorted(set(every) - done)


@given(sizes, st.integers(1, 5), st.integers(1, 20))
def test_more_runs_leave_each_shard_what_it_had(size: tuple[int, int, int], count: int, more: int) -> None:
    points, start = POINTS[: size[0]], size[2]
    for index in range(1, count + 1):
        before = units(points, range(start, start + size[1]), Shard(index, count), {})
        after = units(points, range(start, start + size[1] + more), Shard(index, count), {})
        assert set(before) <= set(after)


def test_a_shard_by_hand() -> None:
    # Unit (point p, run r) belongs to part (p + r) modulo 3.
    assert units(POINTS[:2], range(10, 14), Shard(1, 3), {}) == [(0, 10), (0, 13), (1, 12)]
    assert units(POINTS[:2], range(10, 14), Shard(2, 3), {}) == [(0, 11), (1, 10), (1, 13)]
    assert units(POINTS[:2], range(10, 14), Shard(3, 3), {}) == [(0, 12), (1, 11)]
