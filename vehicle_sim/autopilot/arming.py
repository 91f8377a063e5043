"""Whether a vehicle would arm, and why not: a table of small checks, and the reminder on the ground."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from vehicle_sim.autopilot.boot import NEED_POSITION
from vehicle_sim.autopilot.modes import MODES
from vehicle_sim.autopilot.steering import TIME_SLACK_S

if TYPE_CHECKING:
    from vehicle_sim.autopilot.core import Autopilot

PREARM_PERIOD_S = 30.0  # between two rounds of PreArm texts (recorded)

Check = Callable[["Autopilot"], Iterable[str]]


def _boot(pilot: Autopilot) -> Iterable[str]:
    """What is not ready yet; only a mode that needs a position misses one."""
    for text in pilot.boot.stage.complaints:
        if text != NEED_POSITION or MODES[pilot.mode].needs_position:
            yield text


CHECKS: tuple[Check, ...] = (_boot,)


def complaints(pilot: Autopilot) -> list[str]:
    """Why it would not arm, in its own words; nothing: it would."""
    return [text for check in CHECKS for text in check(pilot)]


class Reminder:
    """Says every 30 s on the ground what keeps the vehicle from arming."""

    def __init__(self, *, started_at_s: float) -> None:
        self._next_s = started_at_s + PREARM_PERIOD_S

    def restart(self, now_s: float) -> None:
        self._next_s = now_s + PREARM_PERIOD_S

    def due(self, pilot: Autopilot) -> list[str]:
        """The texts to say now."""
        if pilot.armed or pilot.now_s < self._next_s - TIME_SLACK_S:
            return []
        self.restart(pilot.now_s)
        return [f"PreArm: {reason}" for reason in complaints(pilot)]
