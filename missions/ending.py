"""How a process is asked to end: a signal, a person's order, or the end of its launcher. It lands, and goes.

SIGTERM, Ctrl-C, and the hangup of its terminal. A second signal means at once, in the air or not; a launcher that ends,
or an order, is never taken for one.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType

SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
PR_SET_PDEATHSIG = 1  # of Linux's prctl: which signal a process gets when who started it ends


class Ending:
    """Whether this process is to end.

    Args:
        tell: says to whoever watches that it was heard.

    Attributes:
        asked: yes. interrupted: by Ctrl-C, whatever other signal came before or after it.
    """

    def __init__(self, tell: Callable[[str], None]) -> None:
        self.asked = False
        self.interrupted = False
        self._signaled = False
        self._times = 0  # asked
        self._tell = tell

    @contextmanager
    def listening(self, *, leash: bool = False) -> Iterator[Ending]:
        """Listen for signals. `leash`: and for the end of standard input, which a launcher holds while it lives.

        The second signal is a KeyboardInterrupt.
        """
        _wake_with_parent()
        before = {number: signal.signal(number, self._hear) for number in SIGNALS}
        if leash:
            threading.Thread(target=_feel, name="leash", args=(self,), daemon=True).start()
        try:
            yield self
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def ask(self) -> None:
        """End, please."""
        self._times += 1
        if not self.asked:
            self.asked = True
            self._tell("asked to end: landing first; a second time ends at once")

    def begin_anew(self) -> Callable[[], bool]:
        """What was asked for is done, and something else begins: signals count anew. Returns whether that is to end."""
        self._signaled, before = False, self._times
        return lambda: self._times > before

    def _hear(self, number: int, frame: FrameType | None) -> None:
        self.interrupted = self.interrupted or number == signal.SIGINT
        if self._signaled and number != signal.SIGHUP:  # a terminal that goes says so twice, and is nobody's haste
            raise KeyboardInterrupt
        self._signaled = True
        self.ask()


def _wake_with_parent() -> None:
    """Who stands still cannot notice that its launcher has ended: Linux lets it go on then, to notice. See prctl(2)."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGCONT)


def _feel(ending: Ending) -> None:
    """Wait for the end of standard input, then ask."""
    with suppress(OSError):
        while os.read(sys.stdin.fileno(), 4096):
            pass
    ending.ask()
