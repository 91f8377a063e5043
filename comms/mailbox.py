"""The latest messages of each sender, for one thread that waits until it has heard from everybody it waits for."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterable

MOST_WAITING = 16  # a sender
MOST_BYTES = 1_000_000  # of a sender


class Mailbox:
    """A short queue a sender: newer messages push out its oldest ones, so that nobody can fill the memory."""

    def __init__(self, senders: Iterable[int]) -> None:
        self._senders = frozenset(senders)
        self._waiting: dict[int, deque[bytes]] = {}
        self._awaited: set[int] = set()
        self._given_up: set[int] = set()  # while nobody waited
        self._lock = threading.Lock()
        self._complete = threading.Event()

    def put(self, sender: int | None, payload: bytes) -> None:
        """A message has come; from any thread. A sender that is not one of ours, or says too much, is not heard."""
        if sender not in self._senders or len(payload) > MOST_BYTES:
            return
        with self._lock:
            queue = self._waiting.setdefault(sender, deque(maxlen=MOST_WAITING))
            queue.append(payload)
            while sum(map(len, queue)) > MOST_BYTES:
                queue.popleft()
            self._strike(sender)

    def give_up(self, sender: int) -> None:
        """Who waits for this one, or is about to, need not; from any thread."""
        with self._lock:
            self._given_up.add(sender)
            self._strike(sender)

    def wake(self) -> None:
        """Who waits is to look around; from any thread."""
        self._complete.set()

    def wait(self, senders: Iterable[int], *, timeout_s: float) -> None:
        """Until there is a message of each of them, or none can come any more, or it takes too long."""
        with self._lock:
            self._awaited = set(senders) - self._waiting.keys() - self._given_up
            self._given_up.clear()
            if not self._awaited:
                return
            self._complete.clear()
        self._complete.wait(timeout_s)

    def take(self) -> dict[int, deque[bytes]]:
        """What has come since the last call, by sender: at least one message of each, the oldest first."""
        with self._lock:
            taken, self._waiting = self._waiting, {}
        return taken

    def _strike(self, sender: int) -> None:
        if sender in self._awaited:
            self._awaited.discard(sender)
            if not self._awaited:
                self._complete.set()
