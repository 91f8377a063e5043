"""When to try again what failed: soon, then ever less often."""

from __future__ import annotations

FIRST_S, LONGEST_S = 0.5, 8.0


class Backoff:
    """The time of the next try. Its clock is the caller's."""

    def __init__(self) -> None:
        self._wait_s = FIRST_S
        self._failed = False
        self._next_s: float | None = None

    def due(self, now_s: float) -> bool:
        """Whether to try now. The wait after a failure begins at the first question."""
        if self._failed:
            self._failed = False
            self._next_s = now_s + self._wait_s
            self._wait_s = min(2.0 * self._wait_s, LONGEST_S)
        return self._next_s is None or now_s >= self._next_s

    def failed(self) -> None:
        """A try failed, or what it opened was lost."""
        self._failed = True

    def succeeded(self) -> None:
        """The next failure is a first one again."""
        self._wait_s, self._failed, self._next_s = FIRST_S, False, None
