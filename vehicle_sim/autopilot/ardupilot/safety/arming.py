"""Whether a vehicle would arm, and why not: a table of small checks, and the reminder on the ground."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from vehicle_sim.autopilot.ardupilot.boot import NEED_POSITION
from vehicle_sim.autopilot.ardupilot.modes import MODES
from vehicle_sim.autopilot.ardupilot.safety.battery import Level, shortage
from vehicle_sim.autopilot.ardupilot.watched import Watched
from vehicle_sim.autopilot.steering import TIME_SLACK_S

PREARM_PERIOD_S = 30.0  # between two rounds of PreArm texts (recorded)

# Bits of ARMING_CHECK. A mandatory check has none; ALL switches on every other.
MANDATORY, ALL, COMPASS, GPS, INERTIA, PARAMETERS, BATTERY = 0, 1, 4, 8, 16, 32, 256
DEAD_COMPASS = "Compass not healthy"
BOOT_BITS = {"Accels inconsistent": INERTIA, "Gyros inconsistent": INERTIA, DEAD_COMPASS: COMPASS}
LEAST_LEAN_CDEG, LARGEST_LEAN_CDEG = 100, 8000  # what an airframe here can have (ArduCopter: from 1000)

Complaint = tuple[int, str]  # the bit that switches it off, and its text
Check = Callable[[Watched], Iterator[Complaint]]


def _boot(pilot: Watched) -> Iterator[Complaint]:
    """What is not ready yet."""
    for text in pilot.boot.stage.complaints:
        if text != NEED_POSITION:
            yield BOOT_BITS.get(text, MANDATORY), text


def _position(pilot: Watched) -> Iterator[Complaint]:
    """Only a mode that needs a position misses one."""
    if not pilot.boot.stage.origin or not MODES[pilot.mode].needs_position:
        return
    if not pilot.has_position:
        yield MANDATORY, NEED_POSITION
    elif pilot.estimate.glitching:
        yield MANDATORY, "GPS glitching"
    elif not pilot.sensors.has_fix:
        yield GPS, "GPS 1: Bad fix"


def _compass(pilot: Watched) -> Iterator[Complaint]:
    if pilot.boot.stage.position and pilot.sensors.faults.compass_dead:
        yield COMPASS, DEAD_COMPASS


def _battery(pilot: Watched) -> Iterator[Complaint]:
    """The first thing that is wrong with it."""
    parameters, charge = pilot.parameters, pilot.charge
    left_mah = parameters["BATT_CAPACITY"] - charge.consumed_mah
    low_voltage, low_charge = shortage(pilot, Level.LOW)
    critical_voltage, critical_charge = shortage(pilot, Level.CRITICAL)
    wrong = (
        (charge.voltage_v < parameters["BATT_ARM_VOLT"], "below minimum arming voltage"),
        (parameters["BATT_ARM_MAH"] > 0.0 and left_mah < parameters["BATT_ARM_MAH"], "below minimum arming capacity"),
        (low_voltage, "low voltage failsafe"),
        (low_charge, "low capacity failsafe"),
        (critical_voltage, "critical voltage failsafe"),
        (critical_charge, "critical capacity failsafe"),
        (0.0 < parameters["BATT_LOW_MAH"] < parameters["BATT_CRT_MAH"], "capacity failsafe critical > low"),
        (0.0 < parameters["BATT_LOW_VOLT"] < parameters["BATT_CRT_VOLT"], "voltage failsafe critical > low"),
    )
    for is_so, text in wrong:
        if is_so:
            yield BATTERY, f"Battery 1 {text}"
            return


def _parameters(pilot: Watched) -> Iterator[Complaint]:
    if not LEAST_LEAN_CDEG <= pilot.parameters["ANGLE_MAX"] <= LARGEST_LEAN_CDEG:
        yield PARAMETERS, "Check ANGLE_MAX"


def _fence(pilot: Watched) -> Iterator[Complaint]:
    if pilot.outside:
        yield MANDATORY, f"vehicle outside {pilot.outside} fence"


CHECKS: tuple[Check, ...] = (_boot, _position, _compass, _battery, _parameters, _fence)


def complaints(pilot: Watched) -> list[str]:
    """Why it would not arm, in its own words; nothing: it would."""
    asked = int(pilot.parameters["ARMING_CHECK"])
    return [text for check in CHECKS for bit, text in check(pilot) if bit == MANDATORY or asked & ALL or asked & bit]


class Reminder:
    """Says every 30 s on the ground what keeps the vehicle from arming."""

    def __init__(self, *, started_at_s: float) -> None:
        self._next_s = started_at_s + PREARM_PERIOD_S

    def restart(self, now_s: float) -> None:
        self._next_s = now_s + PREARM_PERIOD_S

    def due(self, pilot: Watched) -> list[str]:
        """The texts to say now."""
        if pilot.armed or pilot.now_s < self._next_s - TIME_SLACK_S:
            return []
        self.restart(pilot.now_s)
        return [f"PreArm: {reason}" for reason in complaints(pilot)]
