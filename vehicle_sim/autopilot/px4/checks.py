"""Whether a mode can be flown, and whether the vehicle would arm in it, and why not. The words are PX4's."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from vehicle_sim.autopilot.px4.modes import MODES, Mode
from vehicle_sim.autopilot.px4.watched import Watched

NO_SUPPLY_CHECK = 894281  # CBRK_SUPPLY_CHK

Check = Callable[[Watched, Mode], Iterator[str]]


def _position(pilot: Watched, mode: Mode) -> Iterator[str]:
    if MODES[mode].needs_position and not pilot.has_position:
        yield "No valid position estimate"


def _setpoints(pilot: Watched, mode: Mode) -> Iterator[str]:
    if mode is Mode.OFFBOARD and not pilot.hears_setpoints:
        yield "No offboard signal"


def _mission(pilot: Watched, mode: Mode) -> Iterator[str]:
    if mode is Mode.MISSION and not pilot.mission.items:
        yield "No valid mission available"


def _sticks(pilot: Watched, mode: Mode) -> Iterator[str]:
    if MODES[mode].manual and not pilot.has_sticks:
        yield "No manual control input"


# What a mode needs to be flown.
NEEDS: tuple[Check, ...] = (_position, _setpoints, _mission, _sticks)


def _boot(pilot: Watched, mode: Mode) -> Iterator[str]:
    yield from pilot.boot.stage.complaints


def _mode(pilot: Watched, mode: Mode) -> Iterator[str]:
    if not MODES[mode].armable:
        yield f"Mode {MODES[mode].word} does not allow arming"


def _fix(pilot: Watched, mode: Mode) -> Iterator[str]:
    """A position that is about to be lost is no position to arm with."""
    if pilot.boot.stage.position and MODES[mode].needs_position and not pilot.sensors.has_fix:
        yield "GPS fix too low"


def _compass(pilot: Watched, mode: Mode) -> Iterator[str]:
    if pilot.sensors.faults.compass_dead:
        yield "Compass Sensor 0 missing"


def _battery(pilot: Watched, mode: Mode) -> Iterator[str]:
    parameters = pilot.parameters
    if parameters["CBRK_SUPPLY_CHK"] != NO_SUPPLY_CHECK and pilot.charge_share < parameters["BAT_CRIT_THR"]:
        yield "Low battery"


def _ground_station(pilot: Watched, mode: Mode) -> Iterator[str]:
    if pilot.parameters["NAV_DLL_ACT"] > 0.0 and not pilot.hears_gcs:
        yield "No connection to the GCS"


def _geofence(pilot: Watched, mode: Mode) -> Iterator[str]:
    if pilot.geofence.breached:
        yield "Vehicle outside geofence"


CHECKS: tuple[Check, ...] = (*NEEDS, _boot, _mode, _fix, _compass, _battery, _ground_station, _geofence)


def can_run(pilot: Watched, mode: Mode) -> bool:
    """Whether `mode` can be flown now."""
    return not any(any(True for _ in need(pilot, mode)) for need in NEEDS)


def complaints(pilot: Watched, mode: Mode) -> list[str]:
    """Why it would not arm in `mode`, each reason once; none: it would."""
    return list(dict.fromkeys(text for check in CHECKS for text in check(pilot, mode)))
