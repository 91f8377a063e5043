"""STATUSTEXT: the autopilot's own words, put together and weighed."""

from __future__ import annotations

from comms.mavlink import Message
from comms.status import Event, Level

CHUNK_CHARACTERS = 50  # a chunk that is shorter is the last one of its text
MAX_CHUNKS = 8
REFUSALS = ("PreArm:", "Arm:", "Arming denied:", "Preflight Fail:")

# MAV_SEVERITY 0 (emergency) to 7 (debug).
LEVELS = (Level.ERROR,) * 4 + (Level.WARNING,) + (Level.INFO,) * 3


class TextAssembler:
    """Joins the chunks of long texts (MAVLink STATUSTEXT `id`, `chunk_seq`); short texts pass straight through."""

    def __init__(self) -> None:
        self._id = 0
        self._chunks: list[str] = []

    def hear(self, message: Message) -> Event | None:
        """The text this message completes, if it completes one."""
        text = clean(message.text)
        if message.id == 0:
            return event_of(message.severity, text)
        if message.id != self._id:
            self._id, self._chunks = message.id, []
        self._chunks.append(message.text)
        if len(message.text) == CHUNK_CHARACTERS and len(self._chunks) < MAX_CHUNKS:
            return None
        text, self._id, self._chunks = clean("".join(self._chunks)), 0, []
        return event_of(message.severity, text)


def event_of(severity: int, text: str) -> Event | None:
    """The text as an event. A refusal to arm says CRITICAL, but is asked again: it is a warning until given up."""
    if not text:
        return None
    level = level_of(severity)
    return Event(Level.WARNING if text.startswith(REFUSALS) and level is Level.ERROR else level, text)


def level_of(severity: int) -> Level:
    """How serious a MAV_SEVERITY is; one that does not exist counts as information."""
    return LEVELS[severity] if 0 <= severity < len(LEVELS) else Level.INFO


def clean(text: str) -> str:
    """The printable part: a text from the wire ends up in terminals and logs."""
    return "".join(character for character in text if character.isprintable()).strip()
