"""The three modes of figure 3."""

from __future__ import annotations

from enum import IntEnum


class Mode(IntEnum):
    """What a robot does: follow what it has tagged, else help whom it has answered, else explore."""

    EXPLORE = 0
    FOLLOW = 1
    HELP = 2
