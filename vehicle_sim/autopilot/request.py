"""A command on its way: what a handler of any flavor is given."""

from __future__ import annotations

from collections.abc import Container
from math import isfinite
from typing import Any, Generic, NamedTuple, TypeVar

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.streams import Streams

ABOVE_SEA, FRAMES = 0, frozenset({0, 3, 5, 6})  # MAV_FRAME: above sea level or home, each with an _INT number
FURTHEST_M = 1e5

A = TypeVar("A", bound=Autopilot)


class Request(NamedTuple, Generic[A]):
    """A command on its way: who it acts on, its seven parameters, and where answers wait for the acknowledgement."""

    pilot: A
    streams: Streams
    params: tuple[float, ...]
    frame: int | None  # of a COMMAND_INT, whose place is in degrees times 1e7; None: a COMMAND_LONG, in degrees
    replies: list[Any]

    @property
    def item(self) -> Item | None:
        """Parameters 5 to 7 as a place; None if they are no place on the globe."""
        x, y, z = self.params[4:7]
        scale = 1e7 if self.frame is None else 1.0
        frame = ABOVE_SEA if self.frame is None else self.frame
        if not (abs(x) * scale <= 9e8 and abs(y) * scale <= 1.8e9 and abs(z) <= FURTHEST_M) or frame not in FRAMES:
            return None
        return Item(0, frame, x=round(x * scale), y=round(y * scale), z=z)

    def number(self, index: int) -> int:
        """Parameter `index` (from 1) as an integer; -1 if it is none."""
        value = self.params[index - 1]
        return int(value) if isfinite(value) and 0.0 <= value < 2.0**32 else -1

    def tell_interval(self, known: Container[int]) -> bool:
        """GET_MESSAGE_INTERVAL: reply with how often parameter 1's message flows here. False if there is no such id.

        Args:
            known: the messages that can be reported; the interval of others is 0, of one that does not flow -1.
        """
        message_id = self.number(1)
        if not 0 <= message_id <= 65535:
            return False
        period_s = self.streams.period_s(message_id)
        period_us = 0 if message_id not in known else -1 if period_s is None else round(period_s * 1e6)
        self.replies.append(dialect.MAVLink_message_interval_message(message_id, period_us))
        return True
