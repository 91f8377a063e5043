"""What people ask and tell a process, kept until it has time to answer."""

from __future__ import annotations

import queue
from collections.abc import Iterator
from contextlib import suppress
from typing import Generic, TypeVar

from comms.session import Network, Question

MAX_WAITING = 100

Whom = TypeVar("Whom")


class Questions(Generic[Whom]):
    """A bounded queue: who asks so often that it is full gets no answer, and asks again."""

    def __init__(self) -> None:
        self._waiting: queue.Queue[tuple[Whom, Question]] = queue.Queue(MAX_WAITING)

    def take_at(self, bus: Network, key_expression: str, whom: Whom) -> None:
        """What is asked there from now on is for `whom`."""

        def keep(question: Question) -> None:
            with suppress(queue.Full):
                self._waiting.put_nowait((whom, question))

        bus.answer(key_expression, keep)

    def waiting(self) -> Iterator[tuple[Whom, Question]]:
        """Whom each question is for, and the question, until none is left."""
        while not self._waiting.empty():
            yield self._waiting.get_nowait()
