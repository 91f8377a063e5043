"""The story of a mission as it goes by: calls for help, losses, what everybody did and said."""

from __future__ import annotations

from collections.abc import Sequence

from missions.observation import Observation
from missions.review.calls import Call, Calls
from missions.review.lanes import Lanes
from missions.review.losses import Loss, Losses
from missions.review.timeline import Line, Timeline


class Story:
    """An observer of all that happens.

    Args:
        speed_m_s, sensing_range_m: of any agent.

    Attributes:
        lanes: what each agent did.
    """

    def __init__(self, *, speed_m_s: float, sensing_range_m: float) -> None:
        self._calls, self._timeline, self.lanes = Calls(), Timeline(), Lanes()
        self._losses = Losses(self._calls, speed_m_s=speed_m_s, sensing_range_m=sensing_range_m)

    def observe(self, seen: Observation) -> None:
        """Note one tick."""
        for observer in (self._calls, self._losses, self.lanes, self._timeline):
            observer.observe(seen)

    @property
    def calls(self) -> Sequence[Call]:
        """Every call, in the order of their beginnings."""
        return self._calls.all

    @property
    def losses(self) -> Sequence[Loss]:
        """Every loss, in order of time."""
        return self._losses.all

    @property
    def lines(self) -> Sequence[Line]:
        """What happened, in order of time."""
        return self._timeline.lines(self.calls, self.losses, self.lanes)
