"""The latest message of each sender, for one thread that waits until it has heard from everybody it waits for."""

from __future__ import annotations

import threading
from collections.abc import Iterable


class Mailbox:
    """One slot a sender: a newer message takes the older one's place, so that nobody can fill the memory."""

    def __init__(self, senders: Iterable[int]) -> None:
        self._senders = frozenset(senders)
        self._slots: dict[int, bytes] = {}
        self._awaited: set[int] = set()
        self._given_up: set[int] = set()  # while nobody waited
        self._lock = threading.Lock()
        self._complete = threading.Event()

    def put(self, sender: int | None, payload: bytes) -> None:
        """A message has come; from any thread. A sender that is not one of ours is not heard."""
        if sender not in self._senders:
            return
        with self._lock:
            self._slots[sender] = payload
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
            self._awaited = set(senders) - self._slots.keys() - self._given_up
            self._given_up.clear()
            if not self._awaited:
                return
            self._complete.clear()
        self._complete.wait(timeout_s)

    def take(self) -> dict[int, bytes]:
        """What has come since the last call, by sender."""
        with self._lock:
            taken, self._slots = self._slots, {}
        return taken

    def _strike(self, sender: int) -> None:
        if sender in self._awaited:
            self._awaited.discard(sender)
            if not self._awaited:
                self._complete.set()
