"""The colors of what agents do, everywhere: recording, plots, page, terminal. 0xRRGGBBAA.

Areas are filled with COLORS, which words in black or white are read on. Lines and words have INKS: the same hues, of a
lightness that is read on a white page and on a black screen, since nobody knows which of them the reader prefers.
"""

from __future__ import annotations

from comms.status import Activity, Level

ACTIVITY_COLORS: dict[Activity, int] = {
    Activity.PREPARING: 0x7F9DBDFF,
    Activity.TAKEN_OVER: 0xFF8FD0FF,
    Activity.EXPLORE: 0x4FA3FFFF,
    Activity.FOLLOW: 0x3DDC97FF,
    Activity.CALLING: 0xFFB020FF,
    Activity.HELPING: 0xC77DFFFF,
    Activity.RETURNING: 0x8A94A6FF,
    Activity.LANDED: 0x5B6472FF,
    Activity.LOST: 0xFF5C5CFF,
}

ACTIVITY_INKS: dict[Activity, int] = {
    Activity.PREPARING: 0x7190B1FF,
    Activity.TAKEN_OVER: 0xD665A9FF,
    Activity.EXPLORE: 0x338FEEFF,
    Activity.FOLLOW: 0x10A16AFF,
    Activity.CALLING: 0xD27300FF,
    Activity.HELPING: 0xB769F0FF,
    Activity.RETURNING: 0x838DA0FF,
    Activity.LANDED: 0x707B8BFF,
    Activity.LOST: 0xFA4E51FF,
}

LEVEL_INKS: dict[Level, int] = {
    Level.INFO: 0x7C8EA8FF,
    Level.WARNING: ACTIVITY_INKS[Activity.CALLING],
    Level.ERROR: ACTIVITY_INKS[Activity.LOST],
}


def hex_color(color: int) -> str:
    """#RRGGBB, as terminals and pages write it."""
    return f"#{color >> 8:06X}"
