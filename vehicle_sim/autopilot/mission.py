"""A mission's course: which item is flown now, which comes next, which was reached. Who flies it is in `navigation`.

Where item 0 is home, a mission begins at 1. Ways are flown one after the other; what lies between two ways is done in
order, beside the flight of the second. As ArduCopter does it; texts are its own.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum

from vehicle_sim.autopilot.plans.commands import COMMANDS, DELAY, JUMP, TAKEOFF, is_way
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.plans.store import Store
from vehicle_sim.autopilot.severity import CRITICAL, INFO

MOST_JUMPS = 64  # in search of one next item
FOREVER = -1  # DO_JUMP's count


class State(IntEnum):
    """MISSION_CURRENT.mission_state."""

    NONE = 1
    NOT_STARTED = 2
    ACTIVE = 3
    PAUSED = 4
    COMPLETE = 5


class Mission:
    """The course through one stored mission.

    Attributes:
        first: where a mission begins. current: index of the way that is flown; below `first`: none yet.
        sides: indices still to be done beside it. reached: indices to report.
        fresh: the current way has to be begun (again). say: a text (severity, words) for the ground.
    """

    def __init__(self, store: Store, *, first: int, say: Callable[[int, str], None]) -> None:
        self._store = store
        self.first = first
        self.say = say
        self._jumps: dict[int, int] = {}
        self._running = False
        self.complete = False
        self.current = first - 1
        self.sides: list[int] = []
        self.reached: list[int] = []
        self.fresh = False

    @property
    def items(self) -> tuple[Item, ...]:
        return self._store.flown

    @property
    def state(self) -> State:
        if len(self.items) <= self.first:
            return State.NONE
        if self._running:
            return State.ACTIVE
        if self.complete:
            return State.COMPLETE
        return State.PAUSED if self.current >= self.first else State.NOT_STARTED

    def begins_with_takeoff(self, *, restarts: bool) -> bool:
        """Whether the next way to fly is a takeoff, delays aside."""
        index = self.first if restarts or self.complete else max(self.first, self.current)
        for _ in range(16):
            way = self._next_way(index)
            if way is None or self.items[way].command != DELAY:
                return way is not None and self.items[way].command == TAKEOFF
            index = way + 1
        return False

    def following_way(self) -> Item | None:
        """The way behind the current one, without taking any jump for good."""
        way = self._next_way(self.current + 1)
        return None if way is None else self.items[way]

    def begin(self, *, restarts: bool) -> None:
        """AUTO is entered: from the first item, or on from where it was left."""
        if restarts or self.complete or not self.first <= self.current < len(self.items):
            self.reset()
        self.complete = False
        self._running = self.fresh = True
        if self.current < self.first:
            self.advance()
        elif not is_way(self.items[self.current].command):  # another mission came, and has no way here
            self.current -= 1
            self.advance()

    def stop(self) -> None:
        """AUTO is left."""
        self._running = False

    def reset(self) -> None:
        """Back to the beginning: the vehicle disarmed. What is complete stays so until it begins again."""
        self._jumps.clear()
        self._running = self.fresh = False
        self.current = self.first - 1
        self.sides.clear()

    def select(self, index: int) -> bool:
        """Fly item `index` next (0: from the beginning). False if there is none."""
        if not 0 <= index < len(self.items) or len(self.items) <= self.first:
            return False
        if index == 0 or self.complete:
            self._jumps.clear()
        self.complete = False
        self.current = max(self.first, index) - 1
        self.advance(announce=self._running)
        return True

    def advance(self, *, announce: bool = True) -> bool:
        """On to the next way; False at the end of the mission."""
        self.sides.clear()
        index = self.current + 1
        for _ in range(len(self.items) + MOST_JUMPS):
            found = self._find(index, self._jumps)
            if found is None:
                break
            if is_way(self.items[found].command):
                self.current, self.fresh = found, True
                if announce:
                    self.tell(found)
                return True
            self.sides.append(found)
            index = found + 1
        self._running, self.complete = False, True
        return False

    def reach(self, index: int) -> None:
        self.reached.append(index)

    def changed(self) -> None:
        """The stored items changed: what is being flown begins again, as it is now."""
        self.sides.clear()
        if not self._running:
            self.current = min(self.current, max(self.first, len(self.items)) - 1)
        elif not is_way(self.items[self.current].command) if self.current < len(self.items) else True:
            self.advance()
        else:
            self.fresh = True
            self.say(CRITICAL, "Auto mission changed, restarted command")

    def tell(self, index: int) -> None:
        self.say(INFO, f"Mission: {index} {COMMANDS[self.items[index].command].word}")

    def _next_way(self, index: int) -> int | None:
        jumps = dict(self._jumps)
        for _ in range(len(self.items) + MOST_JUMPS):
            found = self._find(index, jumps)
            if found is None or is_way(self.items[found].command):
                return found
            index = found + 1
        return None

    def _find(self, index: int, jumps: dict[int, int]) -> int | None:
        """The first item at or after `index` that is no jump, following jumps that have turns left."""
        for _ in range(MOST_JUMPS):
            if index >= len(self.items):
                return None
            item = self.items[index]
            if item.command != JUMP:
                return index
            turns, done = int(item.param2), jumps.get(index, 0)
            if turns == FOREVER or done < turns:
                jumps[index] = done + 1
                index = int(item.param1)
            else:
                index += 1
        return None
