"""The flight modes of an ArduCopter that this autopilot has. Read the table, know the modes."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple


class Mode(IntEnum):
    """HEARTBEAT.custom_mode."""

    STABILIZE = 0
    ALT_HOLD = 2
    AUTO = 3
    GUIDED = 4
    LOITER = 5
    RTL = 6
    LAND = 9
    POSHOLD = 16
    BRAKE = 17
    SMART_RTL = 21


class ModeRow(NamedTuple):
    """What a mode is like.

    Attributes:
        needs_position: cannot be entered while armed, nor armed in, without a position estimate.
        armable: may be armed in. autonomous: HEARTBEAT.base_mode says GUIDED_ENABLED.
        takes_off: NAV_TAKEOFF works; in ALT_HOLD only one that need not navigate (its parameter 3 is not 0).
        sticks: a pilot's throttle sets its climb rate; without a radio that throttle is at its bottom.
        lands: disarms itself soon after a touchdown.
    """

    needs_position: bool
    armable: bool
    autonomous: bool = False
    takes_off: bool = False
    sticks: bool = False
    lands: bool = False


MODES: dict[Mode, ModeRow] = {
    Mode.STABILIZE: ModeRow(needs_position=False, armable=True),
    Mode.ALT_HOLD: ModeRow(needs_position=False, armable=True, takes_off=True, sticks=True),
    Mode.AUTO: ModeRow(needs_position=True, armable=False, autonomous=True),
    Mode.GUIDED: ModeRow(needs_position=True, armable=True, autonomous=True, takes_off=True),
    Mode.LOITER: ModeRow(needs_position=True, armable=True, autonomous=True, takes_off=True, sticks=True),
    Mode.RTL: ModeRow(needs_position=True, armable=False, autonomous=True, lands=True),
    Mode.LAND: ModeRow(needs_position=False, armable=False, lands=True),
    Mode.POSHOLD: ModeRow(needs_position=True, armable=True, autonomous=True, takes_off=True, sticks=True),
    Mode.BRAKE: ModeRow(needs_position=True, armable=False, autonomous=True),
    Mode.SMART_RTL: ModeRow(needs_position=True, armable=False, autonomous=True, lands=True),
}
