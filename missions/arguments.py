"""What may stand behind an option of the command line: each takes the words and returns what they mean.

Errors say what was given and what is allowed.
"""

from __future__ import annotations

import argparse
from math import inf, isfinite
from pathlib import Path

MOST_UNIX_S = 4_102_444_800.0  # 2100


def speed(text: str) -> float:
    """Times real time; `max` is as fast as it goes."""
    if text == "max":
        return inf
    try:
        speed = float(text)
    except ValueError:
        speed = 0.0
    if not (speed > 0 and isfinite(speed)):
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: a number above 0, or max')
    return speed


def whole(text: str) -> int:
    """A whole number from 0 on."""
    if not (text.isascii() and text.isdigit()):
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: a whole number, 0 or more')
    return int(text)


def count(text: str) -> int:
    """A whole number from 1 on."""
    if not (text.isascii() and text.isdigit() and int(text) > 0):
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: a whole number above 0')
    return int(text)


def new_file(text: str) -> Path:
    """A file that can be made or replaced."""
    path = Path(text)
    if not path.parent.is_dir():
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: a file in a directory that exists')
    if text == "-" or (path.exists() and not path.is_file()):
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: an ordinary file')
    return path


def report(text: str) -> str:
    """A file, or `-` for standard output."""
    return text if text == "-" else str(new_file(text))


def unix_time(text: str) -> float:
    """A time, seconds since 1970."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < MOST_UNIX_S:
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: seconds since 1970')
    return value


def seconds(text: str) -> float:
    """A time, more than 0, up to a day."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value <= 86_400.0:
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: seconds, more than 0')
    return value
