"""What is said to whoever looks on. When nobody does any more, it is lost, and nothing else is: no flight ends so."""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import IO, TYPE_CHECKING, TextIO, cast

if TYPE_CHECKING:
    from rich.console import Console

# A pipe without a reader, a terminal that has gone, a stream that is closed; a write that a signal has interrupted.
LOST = (OSError, ValueError, RuntimeError)


class Outlet:
    """Standard output or standard error, as it is at each write, but that never raises."""

    def __init__(self, *, stderr: bool) -> None:
        self._stderr = stderr

    def write(self, text: str) -> int:
        """Say it, if anybody hears it."""
        try:
            return self._stream.write(text)
        except LOST:
            return len(text)

    def flush(self) -> None:
        """Let it go out now."""
        with suppress(*LOST):
            self._stream.flush()

    def isatty(self) -> bool:
        """Whether a person looks at it."""
        try:
            return self._stream.isatty()
        except LOST:
            return False

    def fileno(self) -> int:
        """Its file, of which a terminal tells its size."""
        return self._stream.fileno()

    @property
    def encoding(self) -> str:
        """Its letters."""
        return self._stream.encoding

    @property
    def _stream(self) -> TextIO:
        return sys.stderr if self._stderr else sys.stdout


def outlet_console(*, stderr: bool) -> Console:
    """A console for use in a flight."""
    from rich.console import Console

    return Console(file=cast(IO[str], Outlet(stderr=stderr)))
