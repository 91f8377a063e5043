"""Waiting for what is about to happen: for an event and never for a while, and long enough for a busy computer."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic, sleep

PATIENCE_S = 120.0  # for what takes milliseconds, or the start of a process, on a computer that does ten other things


def until(holds: Callable[[], object]) -> None:
    """Until it is so; it is asked a hundred times a second."""
    deadline_s = monotonic() + PATIENCE_S
    while not holds():
        assert monotonic() < deadline_s, "it never happened"
        sleep(0.01)
