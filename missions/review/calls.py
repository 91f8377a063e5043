"""Help calls, one by one: who called for what, who set out, and how it ended."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from comms.status import AgentStatus, HelpCallStatus
from missions.metrics import CALL_PAUSE_S, pursues
from missions.observation import Observation


class Fate(StrEnum):
    """How a call ended, for the target that was called for."""

    HANDED_OVER = "handed over to"  # a helper has it
    TAKEN = "taken by passer-by"  # somebody has it who had not set out to help
    KEPT = "kept"  # the caller follows it still, or again
    LOST = "lost"  # nobody has it
    OPEN = "out until the end"  # the mission ended first


@dataclass(slots=True)
class Call:
    """One agent calling for one target, however often it is renewed.

    Attributes:
        began_s, ended_s: mission clock of the first and the last tick with the call out.
        urgent: whether a loss was foreseen at any time; else it was an offer. loss_in_s: as foreseen at first.
        helpers: who set out for the target meanwhile, in order. owner: who has it in the end, if anybody.
    """

    caller: int
    target: int
    began_s: float
    ended_s: float
    urgent: bool
    loss_in_s: float
    helpers: list[int] = field(default_factory=list)
    fate: Fate = Fate.OPEN
    owner: int | None = None

    @property
    def lasted_s(self) -> float:
        """How long it was out."""
        return self.ended_s - self.began_s


class Calls:
    """An observer of help calls. One that pauses for CALL_PAUSE_S is over.

    Attributes:
        all: every call of the mission, in the order of their beginnings; as many as the report counts.
    """

    def __init__(self) -> None:
        self.all: list[Call] = []
        self._open: dict[tuple[int, int], Call] = {}  # by (caller, target)

    def observe(self, seen: Observation) -> None:
        """End calls, renew them, begin them, and note who sets out."""
        if seen.mission_tick is None:
            return
        for key, call in list(self._open.items()):
            if seen.time_s - call.ended_s > CALL_PAUSE_S:
                call.fate, call.owner = _fate(call, seen.statuses)
                del self._open[key]
        for status in seen.statuses:
            for told in status.calls:
                call = self._of(status.uid, told, seen.time_s)
                call.ended_s = seen.time_s
                call.urgent |= told.urgent
        for (caller, target), call in self._open.items():
            for status in seen.statuses:
                known = status.uid == caller or status.uid in call.helpers
                if status.helping == target and not known and not pursues(status):
                    call.helpers.append(status.uid)

    def out(self, target: int, callers: Collection[int]) -> Call | None:
        """The first of the calls for the target, by one of these, that are out or pause."""
        return next(
            (call for call in self._open.values() if call.target == target and call.caller in callers),
            None,
        )

    def _of(self, caller: int, told: HelpCallStatus, time_s: float) -> Call:
        key = caller, told.target
        if key not in self._open:
            self._open[key] = Call(caller, told.target, time_s, time_s, told.urgent, told.loss_in_s)
            self.all.append(self._open[key])
        return self._open[key]


def _fate(call: Call, statuses: Sequence[AgentStatus]) -> tuple[Fate, int | None]:
    owners = [status.uid for status in statuses if call.target in status.tags]
    if not owners:
        return Fate.LOST, None
    helpers = [uid for uid in owners if uid in call.helpers]
    if helpers:
        return Fate.HANDED_OVER, helpers[0]
    if call.caller in owners:
        return Fate.KEPT, call.caller
    return Fate.TAKEN, owners[0]
