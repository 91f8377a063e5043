"""A bus without a network, for tests of what speaks by one: who subscribes hears at once, who watches is told."""

from __future__ import annotations

from collections.abc import Callable
from fnmatch import fnmatchcase

from comms.session import OnSample, Put, Question


class FakeBus:
    """See `comms.session.Network`. Nobody asks questions here.

    Attributes:
        said: (key, payload) of all that was published.
    """

    def __init__(self) -> None:
        self.said: list[tuple[str, bytes]] = []
        self._hearing: list[tuple[str, OnSample]] = []
        self._watching: list[tuple[str, Callable[[str, bool], None]]] = []

    def publisher(self, key: str) -> Put:
        return lambda payload: self.publish(key, payload)

    def publish(self, key: str, payload: bytes) -> None:
        self.said.append((key, payload))
        for expression, on_sample in self._hearing:
            if fnmatchcase(key, expression):
                on_sample(key, payload)

    def subscribe(self, key_expression: str, on_sample: OnSample) -> None:
        self._hearing.append((key_expression, on_sample))

    def appear(self, key: str, *, is_there: bool = True) -> None:
        """A liveliness token comes, or goes."""
        for expression, on_change in self._watching:
            if fnmatchcase(key, expression):
                on_change(key, is_there)

    def declare_alive(self, key: str) -> Callable[[], None]:
        self.appear(key)
        return lambda: self.appear(key, is_there=False)

    def watch(self, key_expression: str, on_change: Callable[[str, bool], None]) -> None:
        self._watching.append((key_expression, on_change))

    def alive(self, key_expression: str) -> list[str]:
        return []

    def answer(self, key_expression: str, on_question: Callable[[Question], None]) -> None:
        pass

    def ask(self, *key_expressions: str, timeout_s: float) -> list[tuple[str, bytes]]:
        return []
