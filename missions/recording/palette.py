"""The colors of a recording: one for each activity, the same in every view. 0xRRGGBBAA throughout."""

from __future__ import annotations

from missions.colors import ACTIVITY_COLORS as ACTIVITY_COLORS
from missions.colors import LEVEL_COLORS as LEVEL_COLORS

TAGGED = 0xFFE066FF  # ring of a target that somebody owns
SEEN = 0xD8BE58B0  # ring of a target that is seen, and nobody's
UNSEEN = 0xFF5C5CFF  # ring and body of a target out of sight
TARGET = 0xFFF3C4FF

MATE = 0x9FB3C8FF  # another agent, as one agent believes it
REMEMBERED = 0x8A94A6FF  # a target that an agent only remembers
TRUE = 0xD5DCE8FF  # what is so, behind what is believed

BACKGROUND = 0x06080EFF
GROUND = 0x090D17FF  # never seen
GROUND_REMEMBERED = 0x0F233FFF  # seen long ago
GROUND_FRESH = 0x1D5596FF  # seen now
GRID = 0x50689060
EDGE = 0x7D95BFFF
LINK = 0xA9C0E04C
BROKEN = 0xFF5C5CB0  # a frame that was lost on its way

COVERAGE_NOW = 0x3DDC9799
COVERAGE_MEAN = 0xE0559BFF  # neither black nor white: it is seen on a light page and on a dark one
COVERAGE_FLOOR = 0x6E7A90FF
UTILIZATION = 0xFFB020FF
RADIO_SENT = 0x4FA3FFFF
RADIO_DELIVERED = 0x3DDC97FF
RADIO_LOST = 0xFF5C5CFF
RADIO_OUT_OF_RANGE = 0x6E7A90FF
TICK_LATE = 0xFF5C5CFF

# Agents side by side in one plot, where the activity's color would say nothing about who it is.
_SERIES = (
    0x4FA3FFFF, 0x3DDC97FF, 0xFFB020FF, 0xC77DFFFF, 0xFF7AA2FF,
    0x5CE1E6FF, 0xD4E157FF, 0xFF8A5CFF, 0x9AA5FFFF, 0xE0C8A0FF,
)  # fmt: skip


def series_colors(count: int) -> list[int]:
    """A color for each of `count` plotted agents; they repeat after ten."""
    return [_SERIES[number % len(_SERIES)] for number in range(count)]
