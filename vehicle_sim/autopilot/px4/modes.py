"""The flight modes of a PX4 that this autopilot has. Read the table, know the modes."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple


class Mode(IntEnum):
    """HEARTBEAT.custom_mode: the main mode in its third byte, AUTO's sub mode in its fourth (px4_custom_mode.h)."""

    MANUAL = 1 << 16
    ALTCTL = 2 << 16
    POSCTL = 3 << 16
    TAKEOFF = 4 << 16 | 2 << 24
    HOLD = 4 << 16 | 3 << 24
    MISSION = 4 << 16 | 4 << 24
    RTL = 4 << 16 | 5 << 24
    LAND = 4 << 16 | 6 << 24
    ACRO = 5 << 16
    OFFBOARD = 6 << 16
    STABILIZED = 7 << 16


AUTO = 4  # the main mode with sub modes; without one it is MISSION


class ModeRow(NamedTuple):
    """What a mode is like.

    Attributes:
        word: its name in texts. needs_position: it can be neither flown nor armed in without a position.
        manual: it needs a pilot's sticks. auto: it flies by itself. level: it controls the attitude.
        armable: may be armed in.
    """

    word: str
    needs_position: bool = False
    manual: bool = False
    auto: bool = False
    level: bool = True
    armable: bool = True


MODES: dict[Mode, ModeRow] = {
    Mode.MANUAL: ModeRow("Manual", manual=True),
    Mode.ALTCTL: ModeRow("Altitude", manual=True),
    Mode.POSCTL: ModeRow("Position", needs_position=True, manual=True),
    Mode.TAKEOFF: ModeRow("Takeoff", needs_position=True, auto=True),
    Mode.HOLD: ModeRow("Hold", needs_position=True, auto=True),
    Mode.MISSION: ModeRow("Mission", needs_position=True, auto=True),
    Mode.RTL: ModeRow("Return", needs_position=True, auto=True, armable=False),
    Mode.LAND: ModeRow("Land", auto=True, armable=False),  # without a position PX4 descends, and reports this mode
    Mode.ACRO: ModeRow("Acro", manual=True, level=False),
    Mode.OFFBOARD: ModeRow("Offboard", needs_position=True),
    Mode.STABILIZED: ModeRow("Stabilized", manual=True),
}


def mode_of(main: int, sub: int) -> int:
    """The custom_mode that DO_SET_MODE's parameters 2 and 3 ask for."""
    if main == AUTO and sub == 0:
        return int(Mode.MISSION)
    return main << 16 | sub << 24 if main == AUTO else main << 16
