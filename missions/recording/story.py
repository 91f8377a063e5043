"""The mission as a story: a lane of activities for each agent, and the log of events."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import rerun as rr

from comms.status import Activity, Event, Level
from missions.observation import Observation
from missions.recording import palette
from missions.recording.block import Block
from missions.recording.columns import Rows
from missions.recording.scene import Scene

_LEVELS = {
    Level.INFO: rr.TextLogLevel.INFO,
    Level.WARNING: rr.TextLogLevel.WARN,
    Level.ERROR: rr.TextLogLevel.ERROR,
}


class _Line(NamedTuple):
    """One line of the log: when, what, and in which color."""

    observation: Observation
    event: Event
    color: int


class Lanes:
    """A lane for each agent: what it does, recorded when it changes."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._last: list[Activity | None] = [None] * scene.n_agents

    def tell_anew(self) -> None:
        """Tell next what holds, whether it is new or not."""
        self._last = [None] * self._scene.n_agents

    def rows(self, block: Block) -> Iterator[Rows]:
        """The changes."""
        for uid, name in enumerate(self._scene.agent_names):
            changed = []
            for observation in block.observations:
                activity = observation.statuses[uid].activity
                if activity is not self._last[uid]:
                    changed.append(observation)
                    self._last[uid] = activity
            if not changed:
                continue
            states = [observation.statuses[uid].activity.value for observation in changed]
            yield Rows(f"/agents/{name}/mode", Block(self._scene, changed), rr.StateChange.columns(state=states))


class EventLog:
    """What agents and the mission had to report, a log for each speaker."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._names = scene.agent_names

    def rows(self, block: Block) -> Iterator[Rows]:
        """The events."""
        said: dict[str, list[_Line]] = {name: [] for name in ("mission", *self._names)}
        for seen in block.observations:
            said["mission"] += [_Line(seen, event, palette.LEVEL_INKS[event.level]) for event in seen.events]
            for status in seen.statuses:
                if not status.events:
                    continue
                name = self._names[status.uid]
                calm = palette.ACTIVITY_INKS[status.activity]
                for event in status.events:
                    color = calm if event.level is Level.INFO else palette.LEVEL_INKS[event.level]
                    said[name].append(_Line(seen, event, color))
        for name, lines in said.items():
            if lines:
                yield self._log(name, lines)

    def _log(self, name: str, lines: Sequence[_Line]) -> Rows:
        columns = rr.TextLog.columns(
            text=[f"{name}  {line.event.text}" for line in lines],
            level=[_LEVELS[line.event.level] for line in lines],
            color=np.array([line.color for line in lines], dtype=np.uint32),
        )
        return Rows(f"/log/{name}", Block(self._scene, [line.observation for line in lines]), columns)
