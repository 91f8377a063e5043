"""What an agent makes of the world's cues: whether one is of now, and what it does while none comes.

In real time its own clock takes over where the world is silent: it holds still, and its autopilot goes on hearing from
it. In lockstep time itself waits for the world; what the agent missed of it is made up for, holding still as well.

The wall clocks of two computers are not compared: how old a cue is counts from the quickest one so far.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from msgspec import structs

from missions.sides.exchange import Cue

STALE_S = 0.5  # wall clock: what has been under way longer is of the past
SILENT_S = 0.5  # wall clock: without a cue for longer, an agent goes on alone
SILENT_TICKS = 2.0
DRIFT = 1e-3  # clocks of computers differ less: so much a second the quickest cue may be forgotten


class Contact:
    """One agent's contact to the world. All times `now_s` are of this computer's monotonic clock.

    Args:
        period_s: wall seconds a tick; None: in lockstep.
        has_own_radio: its mates hear it without the world, too. Otherwise it is silent where the world is: nobody would
            hear it, or all would, while another process has taken its place.

    Attributes:
        last: the last cue that was heeded.
    """

    def __init__(self, *, period_s: float | None, has_own_radio: bool = False) -> None:
        self.last: Cue | None = None
        self._period_s = period_s
        self._is_silent = not has_own_radio
        self._heard_at_s = 0.0
        self._quickest_s = inf  # when tick 0 would have come, had it come as quickly as any
        self._judged_at_s = 0.0

    def is_stale(self, cue: Cue, now_s: float) -> bool:
        """Whether it has been under way for too long to act on it."""
        if self._period_s is None:
            return False
        began_s = now_s - cue.tick * self._period_s - cue.late_s
        forgotten_s = DRIFT * (now_s - self._judged_at_s)
        self._quickest_s, self._judged_at_s = min(self._quickest_s + forgotten_s, began_s), now_s
        return began_s - self._quickest_s > STALE_S

    def hear(self, cue: Cue, now_s: float) -> None:
        """The world goes on."""
        self.last, self._heard_at_s = cue, now_s

    def silent_s(self, now_s: float) -> float:
        """How long no cue was heeded; for ever if none was."""
        return inf if self.last is None else now_s - self._heard_at_s

    def due_s(self, next_tick: int) -> float:
        """When the agent does this tick alone, unless it is cued before."""
        if self.last is None or self._period_s is None:
            return inf
        silent_s = max(SILENT_S, SILENT_TICKS * self._period_s)
        return self._heard_at_s + max(silent_s, (next_tick - self.last.tick) * self._period_s)

    def alone(self, next_tick: int, now_s: float) -> Cue | None:
        """The agent's own cue for this tick, once it is due."""
        if self.last is None or now_s < self.due_s(next_tick):
            return None
        return structs.replace(_held(self.last, next_tick), silent=self._is_silent)

    def come_home(self, tick: int) -> Cue:
        """The agent's own cue for a tick after the world has ended."""
        return structs.replace(_held(self.last or Cue(tick=tick), tick), come_home=True, silent=True)

    def missed(self, next_tick: int, cue: Cue) -> Iterator[Cue]:
        """In lockstep, the agent's own cues for the ticks before this cue that it was not told of."""
        if self.last is not None and self._period_s is None:
            for tick in range(next_tick, cue.tick):
                yield structs.replace(_held(self.last, tick), silent=True)  # nobody waits for what it says


def _held(last: Cue, tick: int) -> Cue:
    """What an agent tells itself for a tick without a cue, after the last one it had."""
    ahead = tick - last.tick
    return Cue(
        tick=tick,
        mission_tick=None if last.mission_tick is None else last.mission_tick + ahead,
        fault_tick=None if last.fault_tick is None else last.fault_tick + ahead,
        come_home=last.come_home,
        hold=True,
        frames=None,
    )
