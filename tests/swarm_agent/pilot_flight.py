"""A pilot and its vehicle on one wire, ticked together."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from comms.status import Event
from swarm_agent.autopilot import Intent, Phase, Pilot, PilotConfig
from tests.swarm_agent.scripted_copter import HOME, ScriptedCopter


def config(**changes: Any) -> PilotConfig:
    values: dict[str, Any] = {"uid": 3, "system_id": 4, "home": HOME, "altitude_m": 16.0, "max_speed_m_s": 5.0}
    return PilotConfig(**(values | changes))


class Flight:
    """Ticks at 10 Hz; keeps the log and the phases gone through."""

    def __init__(self, copter: ScriptedCopter, **changes: Any) -> None:
        self.copter = copter
        self.pilot = Pilot(config(**changes))
        self.now_s = 0.0
        self.events: list[Event] = []
        self.phases: list[Phase] = [self.pilot.state.phase]
        self._up = b""
        self._down = b""
        self._ticks = 0

    def tick(self, intent: Intent) -> None:
        self.now_s = self._ticks * 0.1
        self._ticks += 1
        self._down = self.copter.tick(self.now_s, self._up)
        self._up = self.pilot.tick(self.now_s, self._down, intent)
        self.events += self.pilot.take_events()
        phase = self.pilot.state.phase
        if self.phases[-1] is not phase:
            self.phases.append(phase)

    def run(self, intent: Intent, *, seconds: float = 300.0, until: Callable[[], bool] | None = None) -> Flight:
        """Tick until the condition holds; with a condition, not reaching it is a failure."""
        end = self._ticks + round(seconds * 10)
        while self._ticks < end:
            self.tick(intent)
            if until is not None and until():
                return self
        assert until is None, f"not in {seconds} s: {self.pilot.state}, log {self.texts[-10:]}"
        return self

    def until(self, phase: Phase, intent: Intent, *, seconds: float = 300.0) -> Flight:
        return self.run(intent, seconds=seconds, until=lambda: self.pilot.state.phase is phase)

    @property
    def texts(self) -> list[str]:
        return [event.text for event in self.events]
