"""How a review writes times and names: 2:31.4, A4, T7; all times are the mission clock, from power-on."""

from __future__ import annotations

import re
from collections.abc import Iterable

from missions.problems import InputError

_CLOCK = re.compile(r"(?:(\d{1,5}):)?(\d{1,6}(?:\.\d{1,6})?)")


def clock(time_s: float) -> str:
    """Minutes, seconds and tenths: 2:31.4."""
    tenths = round(time_s * 10)
    return f"{tenths // 600}:{tenths % 600 // 10:02d}.{tenths % 10}"


def clock_s(text: str) -> float:
    """The time that `clock` wrote, in seconds; plain seconds do as well.

    Raises:
        InputError: it is no time.
    """
    match = _CLOCK.fullmatch(text.strip())
    if match is None:
        raise InputError(f'got "{text}"; allowed: minutes and seconds, such as 2:31.4, or seconds, such as 151.4')
    return 60 * int(match[1] or 0) + float(match[2])


def agent(uid: int) -> str:
    """As in the recording: A4."""
    return f"A{uid}"


def target(number: int) -> str:
    """As in the recording: T7."""
    return f"T{number}"


def agents(uids: Iterable[int]) -> str:
    """A1, A4."""
    return ", ".join(map(agent, uids))


def percent(share: float | None) -> str:
    """90.9 %, or a dash."""
    return "–" if share is None else f"{100 * share:.1f} %"
