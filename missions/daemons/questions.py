"""What people ask and tell a process, kept until it has time to answer."""

from __future__ import annotations

import queue
from collections.abc import Callable
from contextlib import suppress
from typing import Generic, TypeVar

from comms.keys import verb_of
from comms.session import Network, Question
from missions.daemons.orders import Answer, encode_answer

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

    def answer(self, obey: Callable[[Whom, str], Answer]) -> None:
        """Answer what waits.

        Args:
            obey: is given whom a question is for, and its verb.
        """
        while not self._waiting.empty():
            whom, question = self._waiting.get_nowait()
            question.answer(encode_answer(obey(whom, verb_of(question.key))))
