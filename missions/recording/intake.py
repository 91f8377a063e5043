"""Observations on their way to the recorder: what comes too fast waits, or is dropped, but for what was said."""

from __future__ import annotations

import queue
from dataclasses import replace

from msgspec import structs

from missions.observation import Observation

# Of each speaker, in a row of dropped ticks.
_MOST_WORDS = 100


class Intake:
    """A bounded queue from the mission to the recorder.

    Args:
        length: observations that may wait. lossless: whoever brings more waits; else more are dropped and counted.

    Attributes:
        dropped: observations that are missing. is_used: one was brought.

    Machines are overloaded just when much goes wrong, so that no words are dropped: the next observation that fits
    has those of the ones before it, too. The last observation always fits.
    """

    def __init__(self, length: int, *, lossless: bool) -> None:
        self.dropped = 0
        self.is_used = False
        self._queue: queue.Queue[Observation | None] = queue.Queue(length)
        self._lossless = lossless
        self._unsaid: Observation | None = None  # the last that was dropped, with the words of those before it

    def put(self, observation: Observation) -> None:
        """Bring one. Costs a queue entry."""
        self.is_used = True
        if self._lossless:
            self._queue.put(observation)
            return
        observation = observation if self._unsaid is None else _with_words(observation, self._unsaid)
        try:
            self._queue.put_nowait(observation)
            self._unsaid = None
        except queue.Full:
            self._unsaid = observation
            self.dropped += 1

    def end(self) -> None:
        """No more will come."""
        if self._unsaid is not None:
            self._queue.put(self._unsaid)
            self.dropped -= 1
        self._queue.put(None)

    def take(self) -> Observation | None:
        """Wait for the next one; None after the last."""
        return self._queue.get()


def _with_words(observation: Observation, former: Observation) -> Observation:
    """`observation`, saying first what `former` had to say."""
    statuses = [
        structs.replace(now, events=(*then.events, *now.events)[-_MOST_WORDS:]) if then.events else now
        for then, now in zip(former.statuses, observation.statuses, strict=True)
    ]
    events = (*former.events, *observation.events)[-_MOST_WORDS:]
    return replace(observation, statuses=tuple(statuses), events=events)
