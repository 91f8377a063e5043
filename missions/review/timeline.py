"""The mission as a readable timeline: `2:31.4 A4 FOLLOW calls for help: T7, in 4 s`.

Agents and autopilots tell it in their own words, as they are recorded. What nobody on board can know is added: how a
call ended, which target everybody lost, and who could have prevented it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from comms.status import OFF_DUTY, Activity, AgentStatus, Level
from missions.observation import Observation
from missions.review.calls import Call
from missions.review.lanes import Lanes
from missions.review.losses import Chance, Loss
from missions.review.words import agent, agents, clock, target

_DOING = max(len(activity.value) for activity in Activity)
# Where the words of a line begin.
INDENT = 8 + 2 + 7 + 2 + _DOING + 2
# A call that comes and goes with a prediction is told once in so long.
_TOLD_AGAIN_S = 10.0
_ABOUT = re.compile(r".*?\bT\d+\b")
_STARTS = {
    Activity.PREPARING: "prepares",
    Activity.TAKEN_OVER: "is flown by a person",
    Activity.EXPLORE: "explores",
    Activity.RETURNING: "returns",
    Activity.LANDED: "has landed",
    Activity.LOST: "is lost",
}


@dataclass(frozen=True, slots=True)
class Line:
    """One line: when (mission clock), who (None: the mission), doing what, and what happened.

    `routine`: it is said on every flight, or was just said.
    """

    time_s: float
    who: int | None
    activity: Activity | None
    level: Level
    text: str
    routine: bool = False

    def __str__(self) -> str:
        who = "mission" if self.who is None else agent(self.who)
        doing = "" if self.activity is None else self.activity.value.upper()
        return f"{clock(self.time_s):>8}  {who:<7}  {doing:<{_DOING}}  {self.text}"


class Timeline:
    """An observer of what is said, and of what is not said but done."""

    def __init__(self) -> None:
        self._said: list[Line] = []
        self._done: list[Line] = []
        self._last: dict[tuple[int | None, str], tuple[str, float]] = {}
        self._statuses: Sequence[AgentStatus] = ()

    def observe(self, seen: Observation) -> None:
        """Note one tick."""
        if seen.statuses is not self._statuses or seen.events:
            self._said += map(self._echo_aside, _said(seen))
            self._done += _starts(self._statuses or seen.statuses, seen)
        self._statuses = seen.statuses

    def lines(self, calls: Iterable[Call], losses: Iterable[Loss], lanes: Lanes) -> list[Line]:
        """What happened, in order of time."""
        ends = [_line(call.ended_s, call.caller, Level.INFO, call_words(call), lanes) for call in calls]
        lost = [_line(loss.time_s, loss.owners[0], Level.WARNING, loss_words(loss), lanes) for loss in losses]
        return sorted([*self._said, *self._done, *ends, *lost], key=lambda line: line.time_s)

    def _echo_aside(self, line: Line) -> Line:
        """The line, routine if its speaker repeats the last it said of a target; an error is never routine."""
        about = _ABOUT.match(line.text)
        if about is None or line.level is Level.ERROR:
            return line
        words = about[0]
        key = line.who, words.rpartition("T")[2]
        before, at_s = self._last.get(key, ("", 0.0))
        if before == words and line.time_s - at_s < _TOLD_AGAIN_S:
            return replace(line, routine=True)
        self._last[key] = words, line.time_s
        return line


def call_words(call: Call) -> str:
    """How a call ended, on one line."""
    whom = f" {agent(call.owner)}" if call.owner is not None and call.owner != call.caller else ""
    came = f"{agents(call.helpers)} had set out" if call.helpers else "nobody had set out"
    return f"call for {target(call.target)} ends after {call.lasted_s:.1f} s: {call.fate.value}{whom}; {came}"


def loss_words(loss: Loss) -> str:
    """A loss and what would have prevented it, on one line."""
    if loss.left:
        return f"{target(loss.target)} has left the arena"
    gone = f", for {agents(loss.owners)} is out" if loss.owners_gone else ""
    called = "no call was out" if loss.call is None else f"called for {max(0.0, loss.time_s - loss.call.began_s):.1f} s"
    coming = [f"{agents(loss.helpers)} on the way"] if loss.helpers else []
    return "; ".join([f"nobody has {target(loss.target)} any more{gone}", called, *coming, _chance_words(loss)])


def found_words(loss: Loss) -> str:
    """When somebody had the target again."""
    if loss.left:
        return ""
    return "never found again" if loss.found_after_s is None else f"found after {loss.found_after_s:.1f} s"


def _chance_words(loss: Loss) -> str:
    if not loss.chances:
        return "nobody free was near enough"
    best = loss.chances[0]
    return (
        f"{agent(best.agent)} could have come, leaving {loss.time_s - best.leave_by_s:.1f} s before; "
        f"{why_it_did_not(best)}"
    )


def why_it_did_not(chance: Chance) -> str:
    """What kept an agent that could have come: radio, or that nobody had called while there was time."""
    if not chance.in_touch:
        return "it was out of earshot"
    return "it heard the call" if chance.called else "nobody had called by then"


def _said(seen: Observation) -> Iterator[Line]:
    for event in seen.events:
        yield Line(seen.time_s, None, None, event.level, event.text)
    for status in seen.statuses:
        for event in status.events:
            routine = event.level is Level.INFO and status.activity in OFF_DUTY
            yield Line(seen.time_s, status.uid, status.activity, event.level, event.text, routine)


def _starts(before: Sequence[AgentStatus], now: Observation) -> Iterator[Line]:
    """Changes of activity that the speaker itself says nothing about."""
    for old, new in zip(before, now.statuses, strict=True):
        if new.activity is not old.activity and new.activity in _STARTS and not new.events:
            level = Level.WARNING if new.activity is Activity.LOST else Level.INFO
            yield Line(now.time_s, new.uid, new.activity, level, _STARTS[new.activity])


def _line(time_s: float, uid: int, level: Level, text: str, lanes: Lanes) -> Line:
    return Line(time_s, uid, lanes.at(uid, time_s), level, text)
