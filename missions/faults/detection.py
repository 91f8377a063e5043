"""When the swarm notices a fault: read from what agents and their autopilots say."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from comms.status import AgentStatus, Event, Level
from missions.faults.schedule import Spell
from missions.mission.faults import AnyFault, Partition
from missions.observation import Observation
from swarm_agent.mates import RECEPTION, SILENCE

_SILENT = re.compile(rf"{SILENCE} A(\d+)\b")
# What ArduPilot, PX4 and their pilots say of each trouble. PX4 does not say why it is in a failsafe; of wind nobody
# says more than where it has blown them.
_OF_GPS = r"\bGPS\b|\bEKF|\bglitch|\bno position\b|position estimate|requires position|^Failsafe activated"
_OF_BATTERY = r"\bbattery\b"
_OF_BOOT = r"motors are off in flight|\brestarted\b|\bcrash|telemetry has fallen silent|^link lost"
_OF_WIND = r"\bwind\b|outside its fence|fence breached"
_OVER = re.compile(r"\bcleared$", re.IGNORECASE)  # the trouble, and not a sign of it

# Whether what `speaker` says tells of the fault.
Sign = Callable[[Any, int, Event], bool]


@dataclass(frozen=True, slots=True)
class Detection:
    """A fault was noticed: at which tick since the mission began, by whom, and how it was said."""

    tick: int
    agent: int
    words: str


class Detector:
    """An observer that waits for the first sign of every fault, and `patience_ticks` longer than it lasts."""

    def __init__(self, spells: Sequence[Spell], *, patience_ticks: int) -> None:
        self.found: list[Detection | None] = [None] * len(spells)
        self._spells = spells
        self._patience_ticks = patience_ticks

    def observe(self, observation: Observation) -> None:
        """Look at one tick."""
        tick = observation.mission_tick
        if tick is None or all(spell.first > tick for spell in self._spells):
            return
        said = [status for status in observation.statuses if status.events]
        for number, spell in enumerate(self._spells) if said else ():
            open_ = spell.end is None or tick < spell.end + self._patience_ticks
            if self.found[number] is None and spell.first <= tick and open_:
                self.found[number] = _first_sign(spell.fault, said, tick)


def _first_sign(fault: AnyFault, statuses: Sequence[AgentStatus], tick: int) -> Detection | None:
    sign = SIGNS[fault.kind]
    for status in statuses:
        for event in status.events:
            if event.level is not Level.INFO and sign(fault, status.uid, event):
                return Detection(tick, status.uid, event.text)
    return None


def _silent(event: Event) -> int | None:
    """Which mate is told to be silent."""
    match = _SILENT.match(event.text)
    return None if match is None else int(match[1])


def _mate_is_missed(fault: Any, speaker: int, event: Event) -> bool:
    return _silent(event) in fault.agents


def _radio_is_dead(fault: Any, speaker: int, event: Event) -> bool:
    mate = _silent(event)
    return mate is not None and (mate in fault.agents or speaker in fault.agents)


def _other_group_is_missed(fault: Partition, speaker: int, event: Event) -> bool:
    mate = _silent(event)
    return mate is not None and not any(speaker in group and mate in group for group in fault.groups)


def _reception_is_poor(fault: Any, speaker: int, event: Event) -> bool:
    mate = _silent(event)
    if mate is None and not event.text.startswith(RECEPTION):
        return False
    return fault.agents is None or speaker in fault.agents or mate in fault.agents


def _vehicle_says(words: str) -> Sign:
    """An autopilot that is hit, or the pilot of it, complains of this."""
    complaint = re.compile(words, re.IGNORECASE)

    def tells(fault: Any, speaker: int, event: Event) -> bool:
        hit = fault.agents is None or speaker in fault.agents
        return hit and complaint.search(event.text) is not None and _OVER.search(event.text) is None

    return tells


def _never(fault: Any, speaker: int, event: Event) -> bool:
    """Nobody can know."""
    return False


SIGNS: dict[str, Sign] = {
    "kill": _mate_is_missed,
    "freeze": _mate_is_missed,
    "reboot": _vehicle_says(_OF_BOOT),
    "silence": _radio_is_dead,
    "loss": _reception_is_poor,
    "bursts": _reception_is_poor,
    "latency": _reception_is_poor,
    "partition": _other_group_is_missed,
    "gps_lost": _vehicle_says(_OF_GPS),
    "gps_glitch": _vehicle_says(_OF_GPS),
    "battery_low": _vehicle_says(_OF_BATTERY),
    "wind": _vehicle_says(_OF_WIND),
    "identity": _never,
}
