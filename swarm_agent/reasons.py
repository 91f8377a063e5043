"""Why an agent does what it does, in words: each reason is read from the table by the rules that decided."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from swarm_agent.bcmommt.belief import FAR, NOBODY, Table, answered_by_mate, called_by_mate, owned_by_mate
from swarm_agent.bcmommt.help import is_called, is_lost, must_go, time_if_answered, time_until_loss
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Explore, Gate, Params
from swarm_agent.bcmommt.step import Mind

_TOLD_CALLS = 3


class Reasons(NamedTuple):
    """One agent in the tick it has just decided: its table, its mind, and where it is (ENU meters)."""

    table: Table
    params: Params
    mind: Mind
    uid: int
    x_m: float
    y_m: float
    now_s: float

    @property
    def why(self) -> str:
        """Why it goes where it goes, in a sentence."""
        if self.mind.mode is Mode.FOLLOW:
            return self._follows()
        if self.mind.mode is Mode.HELP and self.mind.helping != NOBODY:
            return self._helps(self.mind.helping)
        return self._searches()

    def helping(self, j: int) -> str:
        """Why it sets out for target j."""
        t, p, now = self.table, self.params, self.now_s
        reached = "" if self.mind.capture_s >= FAR else f", there in {self.mind.capture_s:.0f} s"
        if is_lost(t, p, j, now):
            return f"it has lost it itself{reached}"
        if not called_by_mate(t, p, j, now):
            return f"it was sent{reached}"
        remaining = time_until_loss(t, p, j, now)
        when = "has lost it" if remaining <= 0.0 else f"loses it in {remaining:.0f} s"
        if remaining > p.horizon_s - p.tick_s:
            when = "offers it"
        return f"A{t.caller[j]} {when}{reached}"

    def not_helping(self, j: int) -> str:
        """Why it does not (or no longer) go to help with target j."""
        t, p, now = self.table, self.params, self.now_s
        mine = [f"T{k}" for k in t.known if t.tagged[k]]
        if mine:
            return f"it follows {_listed(mine)}"
        if owned_by_mate(t, p, j, now) and t.owner[j] != t.caller[j]:
            return f"A{t.owner[j]} follows it"
        if not is_called(t, p, j, self.x_m, self.y_m, now):
            return "it is not where it should be" if called_by_mate(t, p, j, now) else "the call has ended"
        if time_if_answered(t, p, j, self.x_m, self.y_m, now) >= FAR:
            return "it cannot be there in time" if p.gate == Gate.IN_TIME else "it cannot be caught"
        if answered_by_mate(t, p, j, now):
            return f"A{t.answerer[j]} is quicker, there in {t.answer_capture_s[j]:.0f} s"
        return "another is nearer"

    def leaving(self, j: int) -> str:
        """Why it no longer follows target j, which it has not lost."""
        t = self.table
        if owned_by_mate(t, self.params, j, self.now_s):
            return f"A{t.owner[j]} is nearer, at {t.owner_distance_m[j]:.1f} m"
        return "its call is answered" if t.sensed[j] else "out of sight"

    def losing(self, j: int) -> str:
        """Where a target was when it got lost."""
        t, p = self.table, self.params
        away = hypot(t.x_m[j] - self.x_m, t.y_m[j] - self.y_m)
        others = [f"T{k}" for k in t.known if t.tagged[k]]
        busy = f" while it followed {_listed(others)}" if others else ""
        return f"last seen {away:.1f} m away, of {p.sensing_range_m:.1f} m in sight{busy}"

    def _follows(self) -> str:
        t = self.table
        mine = [j for j in t.known if t.tagged[j]]
        text = f"stays amid {_listed([f'T{j}' for j in mine])}" if len(mine) > 1 else f"follows T{mine[0]}"
        leaving = [f"T{j} in {t.loss_in_s[j]:.0f} s" for j in mine if t.calling[j] and t.loss_in_s[j] < FAR]
        if leaving:
            return f"{text}; calls, for it expects to lose {_listed(leaving)}"
        spare = [f"T{j}" for j in mine if t.calling[j]]
        return f"{text}; offers {_listed(spare)} to whoever is free" if spare else text

    def _helps(self, j: int) -> str:
        goes = must_go(self.table, self.params, j, self.mind.capture_s, self.now_s)
        verb = f"flies to T{j}" if goes else f"will help with T{j}, and searches until it must go"
        return f"{verb}: {self.helping(j)}"

    def _searches(self) -> str:
        p = self.params
        if p.explore == Explore.STALE_FIRST:
            text = "searches the ground that nobody has seen for longest"
        else:
            text = "searches, straight ahead until the edge or a mate turns it"
        calls = [j for j in self.table.known if called_by_mate(self.table, p, j, self.now_s)]
        if not calls:
            return f"{text}; it hears no call for help"
        told = [f"T{j} ({self.not_helping(j)})" for j in calls[:_TOLD_CALLS]]
        more = f" and {len(calls) - _TOLD_CALLS} more" if len(calls) > _TOLD_CALLS else ""
        return f"{text}; it does not help with {_listed(told)}{more}"


def _listed(names: list[str]) -> str:
    """ "T1", "T1 and T2", "T1, T2 and T3"."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
