"""What a daemon says, on standard error: one line an event, `key=value`, with the mission's time.

time_s=12.3 level=warning who=agent-4 text="link lost: no heartbeat for 3 s"
"""

from __future__ import annotations

import json
from collections.abc import Iterable

from comms.status import Event, Level
from missions.outlet import Outlet

LEVELS: tuple[Level, ...] = (Level.INFO, Level.WARNING, Level.ERROR)


class Log:
    """The lines of one process, from `least` on.

    Attributes:
        time_s: the mission clock, as far as this process knows; kept by whoever ticks.
    """

    def __init__(self, who: str, *, least: Level) -> None:
        self.time_s = 0.0
        self._who = who
        self._outlet = Outlet(stderr=True)
        self._shown = frozenset(LEVELS[LEVELS.index(least) :])

    def say(self, level: Level, text: str, *, who: str | None = None) -> None:
        """One line, if it matters enough."""
        if level in self._shown:
            line = f"time_s={self.time_s:.1f} level={level} who={who or self._who} text={json.dumps(text)}\n"
            self._outlet.write(line)
            self._outlet.flush()

    def info(self, text: str) -> None:
        """A line for those who want to know everything."""
        self.say(Level.INFO, text)

    def error(self, text: str) -> None:
        """A line about what went wrong."""
        self.say(Level.ERROR, text)

    def events(self, events: Iterable[Event], *, who: str) -> None:
        """What an agent has to say."""
        for event in events:
            self.say(event.level, event.text, who=who)
