"""The colors of a recording: one for each activity, the same in every view. 0xRRGGBBAA throughout.

The background is the viewer's own, black or white as its user likes: what is drawn on it is read on both.
"""

from __future__ import annotations

from comms.status import Activity
from missions.colors import ACTIVITY_COLORS as ACTIVITY_COLORS
from missions.colors import ACTIVITY_INKS as ACTIVITY_INKS
from missions.colors import LEVEL_INKS as LEVEL_INKS

_GREEN, _RED = ACTIVITY_INKS[Activity.FOLLOW], ACTIVITY_INKS[Activity.LOST]
_BLUE, _ORANGE = ACTIVITY_INKS[Activity.EXPLORE], ACTIVITY_INKS[Activity.CALLING]

TAGGED = 0xBF9A00FF  # ring of a target that somebody owns
SEEN = 0x8F8556FF  # ring of a target that is seen, and nobody's
UNSEEN = _RED  # ring and body of a target out of sight
TARGET = 0xB08A1EFF

MATE = 0x7A8FA4FF  # another agent, as one agent believes it
REMEMBERED = 0x8F8598FF  # a target that an agent only remembers
TRUE = 0x8C96A5FF  # what is so, behind what is believed

# Of the ground, which lets the rest of the background through.
GROUND_SHARE = 0.35
GROUND = 0x22272FFF  # never seen
GROUND_REMEMBERED = 0x1F4C86FF  # seen long ago
GROUND_FRESH = 0x0F7BFFFF  # seen now
GRID = 0x4C5664FF
EDGE = 0x7088B0FF
LINK = 0x6F7F96FF
WRONG = _RED  # a fault of the mission is in force
BROKEN = _RED  # a frame that was lost on its way

COVERAGE_NOW = _GREEN
COVERAGE_MEAN = 0xE0559BFF
COVERAGE_FLOOR = 0x6E7A90FF
UTILIZATION = _ORANGE
RADIO_SENT, RADIO_DELIVERED, RADIO_LOST = _BLUE, _GREEN, _RED
RADIO_OUT_OF_RANGE = 0x6E7A90FF
TICK_LATE = _RED

# Agents side by side in one plot, where the activity's color would say nothing about who it is.
_SERIES = (
    0x338FEEFF, 0x10A16AFF, 0xD27300FF, 0xB769F0FF, 0xE0559BFF,
    0x169DA6FF, 0x8E9A14FF, 0xE2603BFF, 0x7C86F0FF, 0xA88A5CFF,
)  # fmt: skip


def series_colors(count: int) -> list[int]:
    """A color for each of `count` plotted agents; they repeat after ten."""
    return [_SERIES[number % len(_SERIES)] for number in range(count)]
