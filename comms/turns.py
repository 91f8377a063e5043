"""Frames that wait, a few for each sender: who shouts pushes out its own, and nobody else's."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection

MAX_EACH = 8  # one a tick is what is to be said; who was held up says several at once


class Turns:
    """A bounded queue for senders 0 to `n_senders` - 1. One thread may put while another takes."""

    def __init__(self, n_senders: int) -> None:
        self._queues: list[deque[bytes]] = [deque(maxlen=MAX_EACH) for _ in range(n_senders)]

    def missing(self, senders: Collection[int]) -> list[int]:
        """Of which of these nothing waits."""
        return [src for src in senders if not self._queues[src]]

    def put(self, src: int | None, payload: bytes) -> bool:
        """Whether it waits now, and nothing had to go for it: of too many the oldest goes, a stranger's do not wait."""
        if src is None or src >= len(self._queues):
            return False
        queue = self._queues[src]
        has_room = len(queue) < MAX_EACH
        queue.append(payload)
        return has_room

    def take(self) -> list[tuple[int, bytes]]:
        """All that waits, by sender, each one's in its order."""
        return [(src, queue.popleft()) for src, queue in enumerate(self._queues) for _ in range(len(queue))]
