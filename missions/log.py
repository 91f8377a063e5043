"""What agents and their autopilots say while they fly, line by line, for whoever stands beside real vehicles."""

from __future__ import annotations

from rich.console import Console

from comms.status import OFF_DUTY, Level
from missions.observation import Observation

_STYLES = {Level.INFO: "", Level.WARNING: "yellow", Level.ERROR: "bold red"}


class EventLog:
    """An observer that prints events: warnings and errors always; all from agents that are off duty, or just were."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._off_duty: set[int] = set()

    def observe(self, observation: Observation) -> None:
        """Print the events of one tick."""
        for event in observation.events:
            self._print(observation.time_s, "mission", event.level, event.text)
        off_duty = {status.uid for status in observation.statuses if status.activity in OFF_DUTY}
        for status in observation.statuses:
            for event in status.events:
                if event.level is not Level.INFO or status.uid in off_duty | self._off_duty:
                    self._print(observation.time_s, f"A{status.uid}", event.level, event.text)
        self._off_duty = off_duty

    def _print(self, time_s: float, who: str, level: Level, text: str) -> None:
        line = f"{time_s:7.1f} s  {who}: {text}"
        self._console.print(line, style=_STYLES[level], markup=False, emoji=False, highlight=False, soft_wrap=True)
