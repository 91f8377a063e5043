"""A stage of the flight: what a pilot does until the next one. The stages and their order: `Phase`."""

from __future__ import annotations

from typing import Protocol

from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.intent import Intent
from swarm_agent.autopilot.state import Phase


class Stage(Protocol):
    """One row of the state table."""

    @property
    def phase(self) -> Phase:
        """What the agent is told."""

    @property
    def ready(self) -> bool:
        """The vehicle is on its layer and follows `Fly`."""

    @property
    def failure(self) -> str:
        """Why the flight has failed; empty if it has not."""

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Do what is to be done now; the stage for the next tick, itself or another."""


class OnTheWay:
    """What most stages answer: neither ready nor failed."""

    ready = False
    failure = ""
