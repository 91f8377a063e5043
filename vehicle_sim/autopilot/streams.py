"""Which messages flow, and when. On a link of an ArduCopter only HEARTBEAT does until somebody asks for more."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import NamedTuple

from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.autopilot.steering import TIME_SLACK_S

HEARTBEAT_ID = 0
HEARTBEAT_PERIOD_S = 1.0


class Group(NamedTuple):
    """What one REQUEST_DATA_STREAM switches, as ArduCopter 4.5 groups its messages, and the parameter of its rate."""

    parameter: str
    message_ids: tuple[int, ...]


ALL_GROUPS = 0


UNASKED_S: dict[int, float] = {HEARTBEAT_ID: HEARTBEAT_PERIOD_S}


class Streams:
    """The rates one link asked for. A tick sends a message at most once, so the tick rate is the fastest.

    Args:
        unasked_s: the periods of what flows before anybody asks; HEARTBEAT is among them.
    """

    def __init__(self, *, started_at_s: float, unasked_s: Mapping[int, float] = UNASKED_S) -> None:
        self.unasked_s = unasked_s
        self._periods_s = dict(unasked_s)
        self._due_s = dict.fromkeys(unasked_s, started_at_s)
        self._rates_hz: dict[str, float] = {}

    def set_period(self, message_id: int, period_s: float | None, now_s: float) -> None:
        """Send every `period_s` from now on; None: not at all. The heartbeat never slows down: it is a sign of life."""
        if message_id == HEARTBEAT_ID:
            period_s = min(period_s or HEARTBEAT_PERIOD_S, HEARTBEAT_PERIOD_S)
        if period_s is None:
            self._periods_s.pop(message_id, None)
            self._due_s.pop(message_id, None)
            return
        self._periods_s[message_id] = period_s
        self._due_s[message_id] = now_s

    def set_group(self, group: Group, rate_hz: float, known: Container[int], now_s: float) -> None:
        """Send those of its messages that are `known` at `rate_hz`; 0: not at all."""
        period_s = 1.0 / rate_hz if rate_hz > 0.0 else None
        for message_id in group.message_ids:
            if message_id in known:
                self.set_period(message_id, period_s, now_s)

    def follow(self, groups: Iterable[Group], parameters: Parameters, known: Container[int], now_s: float) -> None:
        """Stream as the parameters of `groups` say that have changed since the last call."""
        for group in groups:
            rate_hz = max(0.0, parameters[group.parameter])
            if rate_hz != self._rates_hz.get(group.parameter, 0.0):
                self._rates_hz[group.parameter] = rate_hz
                self.set_group(group, rate_hz, known, now_s)

    def has_usual(self, message_id: int, groups: Iterable[Group]) -> bool:
        """Whether it flows unasked, or belongs to one of `groups`."""
        return message_id in self.unasked_s or any(message_id in group.message_ids for group in groups)

    def usual_s(self, message_id: int, groups: Iterable[Group]) -> float | None:
        """Its period until somebody asks for another: as the parameters say that this link follows, or unasked."""
        rates_hz = [self._rates_hz.get(group.parameter, 0.0) for group in groups if message_id in group.message_ids]
        rate_hz = max(rates_hz, default=0.0)
        return 1.0 / rate_hz if rate_hz > 0.0 else self.unasked_s.get(message_id)

    def period_s(self, message_id: int) -> float | None:
        return self._periods_s.get(message_id)

    def due(self, now_s: float) -> list[int]:
        """The messages to send now. A late one is sent once and keeps its rhythm from here on."""
        due = [message_id for message_id, at_s in self._due_s.items() if at_s <= now_s + TIME_SLACK_S]
        for message_id in due:
            next_s = self._due_s[message_id] + self._periods_s[message_id]
            self._due_s[message_id] = next_s if next_s > now_s + TIME_SLACK_S else now_s + self._periods_s[message_id]
        return due
