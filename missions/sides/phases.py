"""The order of a mission: prepare, mission, return, done, and when one gives way to the next."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor

from comms.status import Activity, Event, Level
from missions.observation import Phase
from missions.sides.exchange import Done

# A preparation or a return that takes longer than this has gone wrong, whatever the pilots say.
PREPARE_LIMIT_S = 600.0
RETURN_LIMIT_S = 1800.0
# Vehicles that persons fly are waited for so long when all others are down: time to land one, or to give it back.
PERSONS_LIMIT_S = 60.0
# Between the last agent's arrival on its layer and the mission: an autopilot that is still ending its climb does not
# follow yet.
SETTLE_S = 2.0
_ANNOUNCED = {
    Phase.PREPARE: "preparing: connect, preflight, takeoff",
    Phase.MISSION: "the mission begins",
    Phase.RETURN: "returning: everybody lands at home",
}


class Phases:
    """Where the mission as a whole stands.

    Attributes:
        now: the phase. began: its first tick. ticks_flown: ticks of MISSION so far.
    """

    def __init__(self, *, tick_s: float, duration_s: float) -> None:
        self.now = Phase.PREPARE
        self.began = 0
        self.ticks_flown = 0
        self._tick_s = tick_s
        self._duration_s = duration_s
        self._duration_ticks = max(1, round(duration_s / tick_s))
        self._stopped = False
        self._ready_since: int | None = None
        self._persons_since: int | None = None
        self._left_to_persons: tuple[int, ...] = ()
        self._mission_began: int | None = None

    @property
    def complete(self) -> bool:
        """Whether MISSION lasted its whole duration."""
        return self.ticks_flown >= self._duration_ticks

    def mission_tick(self, tick: int) -> int | None:
        """Ticks since MISSION began; None outside it."""
        return tick - self.began if self.now is Phase.MISSION else None

    def fault_tick(self, tick: int) -> int | None:
        """Ticks since MISSION began, after its end too; None before it."""
        return None if self._mission_began is None else tick - self._mission_began

    def announcement(self, tick: int) -> tuple[Event, ...]:
        """What is to be said in this tick: that a phase begins, if one does, and that one ends too early."""
        if tick != self.began:
            return tuple(Event(Level.ERROR, f"ends while a person flies A{uid}") for uid in self._left_to_persons)
        begins = Event(Level.INFO, _ANNOUNCED[self.now])
        if not self._stopped:
            return (begins,)
        flown_s = self.ticks_flown * self._tick_s
        return (Event(Level.ERROR, f"stopped after {flown_s:.1f} s of {self._duration_s:g} s"), begins)

    def turn(self, next_tick: int, dones: Sequence[Done], *, stop: bool) -> None:
        """End a tick, in which the agents did this. `stop`: come home."""
        if self.now is Phase.MISSION:
            self.ticks_flown += 1
        phase = self._next(next_tick, dones, stop)
        self._stopped = stop and phase is Phase.RETURN and not self.complete
        if phase is not self.now:
            self.now, self.began = phase, next_tick
            if phase is Phase.MISSION:
                self._mission_began = next_tick

    def _next(self, next_tick: int, dones: Sequence[Done], stop: bool) -> Phase:
        in_phase_s = floor((next_tick - self.began) * self._tick_s)
        nobody_left = all(_has_ended(done) for done in dones)
        if self.now is Phase.RETURN:
            over = nobody_left or self._left_to_persons or in_phase_s >= RETURN_LIMIT_S
            self._leave_to_persons(next_tick, dones)
            return Phase.DONE if over else Phase.RETURN
        if stop:
            return Phase.RETURN
        if self.now is Phase.PREPARE:
            # An agent that cannot fly must not keep the others on the ground.
            waiting = [done for done in dones if done.status.activity is not Activity.LOST]
            if nobody_left or in_phase_s >= PREPARE_LIMIT_S:
                return Phase.RETURN
            return Phase.MISSION if waiting and self._settled(next_tick, waiting) else Phase.PREPARE
        return Phase.RETURN if self.complete or nobody_left else Phase.MISSION

    def _leave_to_persons(self, tick: int, dones: Sequence[Done]) -> None:
        """Note who is not waited for any longer; the tick that follows says so, and is the last."""
        flying = [done.status for done in dones if not _has_ended(done)]
        if not all(status.activity is Activity.TAKEN_OVER for status in flying):
            self._persons_since = None
            return
        if self._persons_since is None:
            self._persons_since = tick
        if (tick - self._persons_since) * self._tick_s >= PERSONS_LIMIT_S:
            self._left_to_persons = tuple(status.uid for status in flying)

    def _settled(self, tick: int, waiting: Sequence[Done]) -> bool:
        if not all(done.ready for done in waiting):
            self._ready_since = None
            return False
        if self._ready_since is None:
            self._ready_since = tick
        return (tick - self._ready_since) * self._tick_s >= SETTLE_S


def _has_ended(done: Done) -> bool:
    """Landed, or lost and lying on the ground; one that is lost in the air may yet come down while it is heard."""
    if done.status.activity not in (Activity.LANDED, Activity.LOST):
        return False
    return done.unheard or done.on_ground
