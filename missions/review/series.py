"""What is counted and drawn over time: a few numbers of every tick, however many agents there are."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import chain
from math import nan

from comms.status import Activity, AgentStatus
from missions.observation import Observation


@dataclass(slots=True)
class Bucket:
    """A slice of MISSION: targets seen and present, summed over its ticks, and agents by what they did."""

    seen: int = 0
    present: int = 0
    activities: Counter[Activity] = field(default_factory=Counter)

    @property
    def coverage(self) -> float | None:
        """Share of the present targets that were seen."""
        return self.seen / self.present if self.present else None


class Series:
    """An observer of every tick.

    Attributes:
        time_s: mission clock. deeds, places: prints of what everybody did and followed, and of where everybody was: in
            one process equal prints mean the same. One of each for every tick.
        flown_s, coverage, coverage_mean: mission clock, share seen (nan: unknown) and its mean so far, of MISSION.
    """

    def __init__(self) -> None:
        self.time_s, self.deeds, self.places = array("d"), array("q"), array("q")
        self.flown_s, self.coverage, self.coverage_mean = array("d"), array("d"), array("d")
        self._seen, self._present = array("L"), array("L")
        self._activities: list[Counter[Activity]] = []  # one object while nobody changes
        self._statuses: Sequence[AgentStatus] = ()

    def observe(self, seen: Observation) -> None:
        """Note one tick."""
        changed = seen.statuses is not self._statuses
        self._statuses = seen.statuses
        self.time_s.append(seen.time_s)
        self.deeds.append(_deeds(seen) if changed else self.deeds[-1])
        self.places.append(_places(seen))
        if seen.mission_tick is None:
            return
        self.flown_s.append(seen.time_s)
        self.coverage.append(_number(seen.coverage))
        self.coverage_mean.append(_number(seen.coverage_mean))
        self._seen.append(sum(target.seen for target in seen.targets))
        self._present.append(sum(target.present for target in seen.targets))
        activities = Counter(status.activity for status in seen.statuses)
        same = self._activities and self._activities[-1] == activities
        self._activities.append(self._activities[-1] if same else activities)

    def buckets(self, count: int) -> list[Bucket]:
        """MISSION in `count` slices of equal length, or as many as it has ticks."""
        ticks = len(self.flown_s)
        slices = [Bucket() for _ in range(min(count, ticks))]
        rows = zip(self._seen, self._present, self._activities, strict=True)
        for number, (seen, present, activities) in enumerate(rows):
            bucket = slices[number * len(slices) // ticks]
            bucket.seen += seen
            bucket.present += present
            bucket.activities.update(activities)
        return slices


def _number(share: float | None) -> float:
    return nan if share is None else share


def _deeds(seen: Observation) -> int:
    return hash(tuple((status.activity, status.tags, status.helping) for status in seen.statuses))


def _places(seen: Observation) -> int:
    agents: Iterable[float] = chain.from_iterable(truth.position_m for truth in seen.truths)
    targets = chain.from_iterable((one.x_m, one.y_m, one.present, one.seen) for one in seen.targets)
    return hash(array("d", chain(agents, targets)).tobytes())
