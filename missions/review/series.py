"""What is drawn over time, in slices of the mission: coverage, and what agents did."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from comms.status import Activity
from missions.review.reading import Review


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


def buckets(review: Review, count: int) -> list[Bucket]:
    """MISSION in `count` slices of equal length, or as many as it has ticks."""
    flown = [seen for seen in review.playback.observations if seen.mission_tick is not None]
    slices = [Bucket() for _ in range(min(count, len(flown)))]
    for number, seen in enumerate(flown):
        bucket = slices[number * len(slices) // len(flown)]
        bucket.seen += sum(target.seen for target in seen.targets)
        bucket.present += sum(target.present for target in seen.targets)
        bucket.activities.update(status.activity for status in seen.statuses)
    return slices
