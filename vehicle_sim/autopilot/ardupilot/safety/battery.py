"""The battery failsafe: low and critical, by voltage and by charge, as AP_BattMonitor decides them."""

from __future__ import annotations

from enum import IntEnum

from vehicle_sim.autopilot.ardupilot.safety.actions import Action, action_of, fail
from vehicle_sim.autopilot.ardupilot.watched import Watched
from vehicle_sim.autopilot.severity import WARNING

# What a battery may ask for, the most urgent first: a later failsafe acts only if it is not less urgent.
BATTERY_PRIORITIES = (
    Action.TERMINATE, Action.LAND, Action.RTL, Action.SMART_RTL_OR_LAND, Action.SMART_RTL_OR_RTL, Action.NONE,
)  # fmt: skip


class Level(IntEnum):
    """How bad a battery is. It stays so until the next power-on."""

    FINE = 0
    LOW = 1
    CRITICAL = 2


# Level -> the text's word, and the parameters: voltage, charge left, action.
BATTERY_LEVELS: dict[Level, tuple[str, str, str, str]] = {
    Level.LOW: ("low", "BATT_LOW_VOLT", "BATT_LOW_MAH", "BATT_FS_LOW_ACT"),
    Level.CRITICAL: ("critical", "BATT_CRT_VOLT", "BATT_CRT_MAH", "BATT_FS_CRT_ACT"),
}


class BatteryFailsafe:
    """Whether voltage or charge are too low; both are looked at only while armed."""

    def __init__(self) -> None:
        self.level = Level.FINE
        self._urgency = len(BATTERY_PRIORITIES)
        self._low_since_s: dict[Level, float] = {}

    def watch(self, pilot: Watched) -> None:
        """Act when the battery becomes worse than it was."""
        if not pilot.armed:
            return
        level = self._level(pilot)
        if level <= self.level:
            return
        self.level = level
        pilot.announce = True
        word, _, _, action_name = BATTERY_LEVELS[level]
        charge = pilot.charge
        pilot.say(WARNING, f"Battery 1 is {word} {charge.voltage_v:.2f}V used {charge.consumed_mah:.0f} mAh")
        action = action_of(pilot.parameters[action_name], Action.NONE)
        urgency = BATTERY_PRIORITIES.index(action) if action in BATTERY_PRIORITIES else len(BATTERY_PRIORITIES)
        if urgency <= self._urgency:
            self._urgency = urgency
            fail(pilot, "Battery", action)

    def _level(self, pilot: Watched) -> Level:
        timer_s = pilot.parameters["BATT_LOW_TIMER"]
        for level in (Level.CRITICAL, Level.LOW):
            low_voltage, low_charge = shortage(pilot, level)
            if not low_voltage:
                self._low_since_s.pop(level, None)
            since_s = self._low_since_s.setdefault(level, pilot.now_s) if low_voltage else pilot.now_s
            if low_charge or (timer_s > 0.0 and pilot.now_s - since_s > timer_s):
                return level
        return Level.FINE


def shortage(pilot: Watched, level: Level) -> tuple[bool, bool]:
    """Whether the voltage and the charge are below those of `level` now."""
    _, voltage_name, charge_name, _ = BATTERY_LEVELS[level]
    lowest_v, least_mah = pilot.parameters[voltage_name], pilot.parameters[charge_name]
    resting = pilot.parameters["BATT_FS_VOLTSRC"] == 1.0
    voltage_v = pilot.charge.resting_v if resting else pilot.charge.voltage_v
    left_mah = pilot.parameters["BATT_CAPACITY"] - pilot.charge.consumed_mah
    return 0.0 < voltage_v < lowest_v, least_mah > 0.0 and left_mah < least_mah
