"""The mission as a story: a lane of activities for each agent, and the log of events."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

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


class Lanes:
    """A lane for each agent: what it does, recorded when it changes."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._last: list[Activity | None] = [None] * scene.n_agents

    def rows(self, block: Block) -> Iterator[Rows]:
        """The changes."""
        for uid, name in enumerate(self._scene.agent_names):
            changed = []
            for observation in block.observations:
                activity = observation.statuses[uid].activity
                if activity is not self._last[uid]:
                    changed.append(observation)
                    self._last[uid] = activity
            states = [observation.statuses[uid].activity.value for observation in changed]
            yield Rows(f"/agents/{name}/mode", Block(self._scene, changed), rr.StateChange.columns(state=states))


class EventLog:
    """Every event that an agent or the mission had to report, a log for each of them."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def rows(self, block: Block) -> Iterator[Rows]:
        """The events."""
        mission = [
            (seen, event, palette.LEVEL_COLORS[Level.INFO]) for seen in block.observations for event in seen.events
        ]
        yield self._log("mission", mission)
        for uid, name in enumerate(self._scene.agent_names):
            said = [
                (seen, event, palette.ACTIVITY_COLORS[seen.statuses[uid].activity])
                for seen in block.observations
                for event in seen.statuses[uid].events
            ]
            yield self._log(name, said)

    def _log(self, name: str, said: Sequence[tuple[Observation, Event, int]]) -> Rows:
        """INFO in the speaker's color, anything worse in the color of its level."""
        calm = [color if event.level is Level.INFO else palette.LEVEL_COLORS[event.level] for _, event, color in said]
        columns = rr.TextLog.columns(
            text=[f"{name}  {event.text}" for _, event, _ in said],
            level=[_LEVELS[event.level] for _, event, _ in said],
            color=np.array(calm, dtype=np.uint32),
        )
        return Rows(f"/log/{name}", Block(self._scene, [seen for seen, _, _ in said]), columns)
