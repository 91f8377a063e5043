"""What agents and their autopilots say while they fly, line by line, for whoever stands beside real vehicles."""

from __future__ import annotations

from rich.console import Console

from comms.status import OFF_DUTY, Level
from missions.observation import Observation

_STYLES = {Level.INFO: "", Level.WARNING: "yellow", Level.ERROR: "bold red"}


class EventLog:
    """An observer that prints events: warnings and errors always, everything from agents that are off duty."""

    def __init__(self, console: Console) -> None:
        self._console = console

    def observe(self, observation: Observation) -> None:
        """Print the events of one tick."""
        for event in observation.events:
            self._print(observation.time_s, "mission", event.level, event.text)
        for status in observation.statuses:
            for event in status.events:
                if event.level is not Level.INFO or status.activity in OFF_DUTY:
                    self._print(observation.time_s, f"agent {status.uid}", event.level, event.text)

    def _print(self, time_s: float, who: str, level: Level, text: str) -> None:
        self._console.print(
            f"{time_s:7.1f} s  {who}: {text}", style=_STYLES[level], markup=False, emoji=False, highlight=False
        )
