"""The words of vehicles in a log: the pieces of a long STATUSTEXT are one text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from comms.mavlink import Message

_PIECE_CHARACTERS = 50  # a piece that is shorter ends its text
_MISSING = "…"


class Said(NamedTuple):
    """A whole text, when it began (seconds) and how serious it is (MAV_SEVERITY)."""

    time_s: float
    severity: int
    text: str


class Texts:
    """Joins what one vehicle says; a piece that is not in the log is shown as missing."""

    def __init__(self) -> None:
        self._begun: Said | None = None
        self._id = 0
        self._next = 0  # the number of the piece that should follow

    def hear(self, time_s: float, message: Message) -> Sequence[Said]:
        """The texts that are whole by now; most have no number, and are one message."""
        text = str(message.text)
        if message.id == 0:
            return [Said(time_s, message.severity, text)]
        other = self.end() if message.id != self._id else []
        begun = self._begun or Said(time_s, message.severity, "")
        gap = _MISSING if message.chunk_seq != self._next else ""
        self._begun = begun._replace(text=begun.text + gap + text)
        self._id, self._next = message.id, message.chunk_seq + 1
        return [*other, *self.end()] if len(text) < _PIECE_CHARACTERS else other

    def end(self) -> Sequence[Said]:
        """The text that was begun, as far as it is known."""
        begun, self._begun, self._id, self._next = self._begun, None, 0, 0
        return [] if begun is None else [begun]
