"""The mission's own faults as a lane: what is wrong now, recorded when it changes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import rerun as rr

from missions.faults.schedule import Spell
from missions.faults.words import whom
from missions.recording.block import Block
from missions.recording.columns import Rows
from missions.recording.scene import Scene

LANE = "/faults"
NONE = "none"


class Hazards:
    """A lane of the faults in force; no lane where a mission has none."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._began: int | None = None  # the tick at which MISSION began
        self._last: str | None = None

    def tell_anew(self) -> None:
        """Tell next what holds, whether it is new or not."""
        self._last = None

    def rows(self, block: Block) -> Iterator[Rows]:
        """The changes."""
        if not self._scene.faults:
            return
        changed, states = [], []
        for seen in block.observations:
            if seen.mission_tick is not None:
                self._began = seen.tick - seen.mission_tick
            state = NONE if self._began is None else in_force(self._scene.faults, seen.tick - self._began)
            if state != self._last:
                changed.append(seen)
                states.append(state)
                self._last = state
        yield Rows(LANE, Block(self._scene, changed), rr.StateChange.columns(state=states))


def in_force(faults: Sequence[Spell], tick: int) -> str:
    """What is wrong so many ticks after MISSION began: "kill: A3 + loss of 30%: all agents", or "none"."""
    return " + ".join(f"{spell.fault.what}: {whom(spell.fault)}" for spell in faults if spell.holds(tick)) or NONE


def states_of(faults: Sequence[Spell]) -> Sequence[str]:
    """All that the lane can say."""
    edges = {edge for spell in faults for edge in (spell.first, spell.end) if edge is not None}
    return [NONE, *sorted({in_force(faults, edge) for edge in edges} - {NONE})]
