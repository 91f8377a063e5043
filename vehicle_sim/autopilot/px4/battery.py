"""How bad a battery is, by the share that is left of it."""

from __future__ import annotations

from enum import IntEnum

from vehicle_sim.autopilot.severity import CRITICAL, EMERGENCY, WARNING


class Level(IntEnum):
    """BATTERY_STATUS.charge_state less 1: how bad a battery is."""

    FINE = 0
    LOW = 1
    CRITICAL = 2
    EMERGENCY = 3


# The gravest first: its threshold, how urgent its text is, and the text.
BATTERY_LEVELS: dict[Level, tuple[str, int, str]] = {
    Level.EMERGENCY: ("BAT_EMERGEN_THR", EMERGENCY, "Emergency battery level, land immediately"),
    Level.CRITICAL: ("BAT_CRIT_THR", CRITICAL, "Critical battery level, land now"),
    Level.LOW: ("BAT_LOW_THR", WARNING, "Low battery level, return advised"),
}
