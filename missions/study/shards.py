"""The work of a study cut up: units (a point and a seed), shards of them, and blocks that are flown in one go."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from missions.study.points import Point

# A block is what is lost when a study is killed, and what one task of a cluster flies.
BLOCK_RUNS = 50


@dataclass(frozen=True, slots=True)
class Shard:
    """Part `index` of `count`, counted from 1. Unit (point p, run r) belongs to part (p + r) modulo `count`."""

    index: int = 1
    count: int = 1

    def has(self, *, point: int, run: int) -> bool:
        """Whether run number `run` (from 0) of point number `point` is this part's."""
        return (point + run) % self.count == self.index - 1

    def __str__(self) -> str:
        return f"{self.index}/{self.count}"


WHOLE = Shard()


@dataclass(frozen=True, slots=True)
class Block:
    """Runs of one point that are flown, and written, together."""

    point: Point
    seeds: tuple[int, ...]


def blocks(
    points: Sequence[Point],
    seeds: Sequence[int],
    *,
    shard: Shard = WHOLE,
    done: Mapping[str, Collection[int]] | None = None,
    at_most: int = BLOCK_RUNS,
) -> Iterator[Block]:
    """What is left to fly of a shard; `done` holds the seeds that have been flown, by the point's digest."""
    flown = {digest: frozenset(theirs) for digest, theirs in (done or {}).items()}
    for point in points:
        theirs = flown.get(point.digest, frozenset())
        left = [seed for run, seed in enumerate(seeds) if shard.has(point=point.number, run=run) and seed not in theirs]
        for start in range(0, len(left), at_most):
            yield Block(point, tuple(left[start : start + at_most]))
