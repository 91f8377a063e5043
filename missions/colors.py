"""The colors of what agents do and of how serious a line is, everywhere: recording, plots, terminal. 0xRRGGBBAA."""

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

LEVEL_COLORS: dict[Level, int] = {Level.INFO: 0x8A9BB4FF, Level.WARNING: 0xFFB020FF, Level.ERROR: 0xFF5C5CFF}


def hex_color(color: int) -> str:
    """#RRGGBB, as terminals and pages write it."""
    return f"#{color >> 8:06X}"
