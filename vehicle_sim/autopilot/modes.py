"""The flight modes of an ArduCopter that this autopilot has. Read the table, know the modes."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple


class Mode(IntEnum):
    """HEARTBEAT.custom_mode. STABILIZE has no pilot here: its throttle is closed, in the air it falls."""

    STABILIZE = 0
    GUIDED = 4
    RTL = 6
    LAND = 9
    BRAKE = 17


class ModeRow(NamedTuple):
    """What a mode is like.

    Attributes:
        needs_position: cannot be entered while armed, nor armed in, without a position estimate.
        armable: may be armed in. autonomous: HEARTBEAT.base_mode says GUIDED_ENABLED.
    """

    needs_position: bool
    armable: bool
    autonomous: bool


MODES: dict[Mode, ModeRow] = {
    Mode.STABILIZE: ModeRow(needs_position=False, armable=True, autonomous=False),
    Mode.GUIDED: ModeRow(needs_position=True, armable=True, autonomous=True),
    Mode.RTL: ModeRow(needs_position=True, armable=False, autonomous=True),
    Mode.LAND: ModeRow(needs_position=False, armable=False, autonomous=False),
    Mode.BRAKE: ModeRow(needs_position=True, armable=False, autonomous=False),
}
