"""STATUSTEXT: a text of an autopilot on the wire, in as many pieces as it needs."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

PIECE_BYTES = 50
MOST_IDS = 0xFFFF


class Texts:
    """Numbers the texts that come in pieces: a receiver puts those of one number together again."""

    def __init__(self) -> None:
        self._id = 0

    def messages(self, severity: int, text: str) -> list[Any]:
        """One message, or one for each 50 bytes; the last piece is shorter than that."""
        wire = text.encode()
        if len(wire) <= PIECE_BYTES:
            return [dialect.MAVLink_statustext_message(severity, wire)]
        self._id = self._id % MOST_IDS + 1
        pieces = [wire[at : at + PIECE_BYTES] for at in range(0, len(wire) + 1, PIECE_BYTES)]
        return [dialect.MAVLink_statustext_message(severity, piece, self._id, k) for k, piece in enumerate(pieces)]
