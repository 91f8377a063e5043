"""What people tell one vehicle, and what it answers. An order stands until another takes its place."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

import msgspec
from msgspec import structs

from comms.status import Activity, Event, Level
from missions.sides.exchange import Cue, Done

MAX_ANSWER_BYTES = 4096


class Verb(StrEnum):
    """What a vehicle can be told."""

    STATUS = "status"  # nothing: how it is
    HOLD = "hold"  # stay where it is, watching
    RESUME = "resume"  # go on after a hold
    RETURN = "return"  # fly home and land there
    LAND = "land"  # land where it is
    STOP = "stop"  # fly home, land, and end the process


class Report(msgspec.Struct, frozen=True, kw_only=True):
    """How a vehicle is.

    Attributes:
        time_s: the mission clock. battery: share left. tags: targets it follows. mates: agents it hears.
        link: share of the frames from its autopilot that are whole. heard_ago_s: since the last one.
        late_s: how late the last tick began. busy_s: how long it took here, both on the wall clock.
    """

    time_s: float
    activity: Activity
    flight_mode: str
    battery: float | None
    tags: tuple[int, ...]
    mates: int
    link: float | None
    heard_ago_s: float
    late_s: float
    busy_s: float


class Answer(msgspec.Struct, frozen=True, kw_only=True):
    """What came of an order: whether it is obeyed, in words, and how the vehicle is."""

    obeyed: bool
    text: str
    report: Report | None = None


@dataclass(slots=True)
class Orders:
    """The orders that stand for one agent."""

    hold: bool = False
    come_home: bool = False
    land: bool = False
    leave: bool = False
    _untold: list[Event] = field(default_factory=list)

    def take(self, word: str, activity: Activity) -> tuple[bool, str]:
        """Obey, if it can be done to a vehicle that does this now: whether it is, and why not."""
        before = self._standing()
        obeyed, text = self._take(word, activity)
        if self._standing() != before:
            self._untold.append(Event(Level.INFO, f"told to {word}: {text}"))
        return obeyed, text

    def amend(self, cue: Cue) -> Cue:
        """The cue as it is under these orders."""
        if not (self.hold or self.come_home):
            return cue
        return structs.replace(cue, hold=self.hold, come_home=cue.come_home or self.come_home, land=self.land)

    def confirm(self, done: Done) -> Done:
        """What came of that cue, with the orders that are new: so they stand in log and recording at their tick."""
        if not self._untold:
            return done
        events, self._untold = (*self._untold, *done.status.events), []
        return structs.replace(done, status=structs.replace(done.status, events=events))

    def _standing(self) -> tuple[bool, ...]:
        return self.hold, self.come_home, self.land, self.leave

    def _take(self, word: str, activity: Activity) -> tuple[bool, str]:
        try:
            verb = Verb(word)
        except ValueError:
            return False, f"knows no {word}"
        if verb is Verb.STATUS:
            return True, ""
        if activity in (Activity.LANDED, Activity.LOST) and verb is not Verb.STOP:
            return verb in (Verb.RETURN, Verb.LAND) and activity is Activity.LANDED, f"is {activity.value}"
        if verb in (Verb.HOLD, Verb.RESUME):
            if self.come_home or self.land or activity is Activity.RETURNING:
                return False, "is on its way down"
            self.hold = verb is Verb.HOLD
            return True, "holds" if self.hold else "goes on"
        self.land = self.land or verb is Verb.LAND
        self.come_home = True
        self.leave = self.leave or verb is Verb.STOP
        return True, "lands" if self.land else "comes home"


class Watch:
    """What a status needs beyond the last done: when the vehicle was heard, and how long a tick took."""

    def __init__(self) -> None:
        self._received = 0
        self._heard_at_s = 0.0
        self._late_s = 0.0
        self._busy_s = 0.0

    def see(self, done: Done, *, time_s: float, late_s: float, busy_s: float) -> None:
        """One tick has been done."""
        self._late_s, self._busy_s = late_s, busy_s
        if done.pilot.received != self._received:
            self._received, self._heard_at_s = done.pilot.received, time_s

    def report(self, done: Done, *, time_s: float) -> Report:
        """How the vehicle is."""
        status, link = done.status, done.pilot
        whole = link.received + link.bad
        return Report(
            time_s=time_s,
            activity=status.activity,
            flight_mode=status.flight_mode,
            battery=status.battery,
            tags=status.tags,
            mates=len(status.mates),
            link=link.received / whole if whole else None,
            heard_ago_s=time_s - self._heard_at_s,
            late_s=self._late_s,
            busy_s=self._busy_s,
        )


def encode_answer(answer: Answer) -> bytes:
    """Its wire form."""
    return msgspec.msgpack.encode(answer)


def decode_answer(wire: bytes) -> Answer | None:
    """The answer in `wire`, if it is one."""
    if len(wire) > MAX_ANSWER_BYTES:
        return None
    try:
        return msgspec.msgpack.decode(wire, type=Answer)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return None
