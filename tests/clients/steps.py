"""A session is a list of steps; each says what it did, and the first that goes wrong ends it."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import TypeVar

Seen = TypeVar("Seen")
WAIT_S = 30.0


class StepError(AssertionError):
    """A step did not go as it must."""


def step(name: str, action: Callable[[], object]) -> None:
    """Do it and print the line; a failure prints which step it was and ends the program with exit code 1."""
    began_s = time.monotonic()
    try:
        said = action()
    except Exception as error:
        print(f"FAILED {name}: {type(error).__name__}: {error}", flush=True)
        sys.stdout.flush()
        raise SystemExit(1) from None
    print(f"{time.monotonic() - began_s:6.1f} s  {name}{'' if said is None else f': {said}'}", flush=True)


def wait_for(what: str, look: Callable[[], Seen | None], *, timeout_s: float = WAIT_S) -> Seen:
    """Look again and again until there is something true to see."""
    give_up_s = time.monotonic() + timeout_s
    while time.monotonic() < give_up_s:
        if seen := look():
            return seen
        time.sleep(0.02)
    raise StepError(f"not within {timeout_s:g} s: {what}")


def expect(true: object, what: str) -> None:
    if not true:
        raise StepError(what)
