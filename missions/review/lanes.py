"""What each agent does, from one change to the next."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from operator import itemgetter

from comms.status import Activity, AgentStatus
from missions.observation import Observation


class Lanes:
    """An observer of activities.

    Attributes:
        of: for each agent, since when (mission clock) it does what, in order of time.
    """

    def __init__(self) -> None:
        self.of: list[list[tuple[float, Activity]]] = []
        self._statuses: Sequence[AgentStatus] = ()

    def observe(self, seen: Observation) -> None:
        """Note who does something else than before."""
        if seen.statuses is self._statuses:
            return
        self._statuses = seen.statuses
        self.of += [[] for _ in range(len(seen.statuses) - len(self.of))]
        for lane, status in zip(self.of, seen.statuses, strict=True):
            if not lane or lane[-1][1] is not status.activity:
                lane.append((seen.time_s, status.activity))

    def at(self, uid: int, time_s: float) -> Activity:
        """What the agent did at a time since the first tick."""
        lane = self.of[uid]
        return lane[bisect_right(lane, time_s, key=itemgetter(0)) - 1][1]
