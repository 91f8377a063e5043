"""The table of topics: every key expression of a mission is built and parsed here, and nowhere else.

    swarm/@v1/<mission>/tx/<uid>             agent -> air: one frame per tick
    swarm/@v1/<mission>/rx/<uid>/<src>       air -> agent: what got through

`@v1` seals the tree: a plain `**` of somebody else does not match it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_ROOT = "swarm/@v1"
_MISSION = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")


@dataclass(frozen=True, slots=True)
class Keys:
    """The keys of one mission.

    Raises:
        ValueError: if the mission's name cannot be one chunk of a key (letters, digits, `_`, `.`, `-`; at most 64).
    """

    mission: str

    def __post_init__(self) -> None:
        if not _MISSION.fullmatch(self.mission):
            raise ValueError(
                f"mission name {self.mission!r} is not usable in a key: letters, digits, _ . - (at most 64)"
            )

    def tx(self, uid: int) -> str:
        """Where agent `uid` sends."""
        return f"{_ROOT}/{self.mission}/tx/{uid}"

    @property
    def every_tx(self) -> str:
        """What the air subscribes to."""
        return f"{_ROOT}/{self.mission}/tx/*"

    def rx(self, uid: int, src: int) -> str:
        """Where agent `uid` hears agent `src`."""
        return f"{_ROOT}/{self.mission}/rx/{uid}/{src}"

    def every_rx(self, uid: int) -> str:
        """What agent `uid` subscribes to: its own receiver and nobody else's."""
        return f"{_ROOT}/{self.mission}/rx/{uid}/*"


def sender(key: str) -> int | None:
    """Who spoke on a `tx` or `rx` key: its last chunk; None if that is not a number."""
    chunk = key.rpartition("/")[2]
    return int(chunk) if chunk.isascii() and chunk.isdigit() and len(chunk) <= 9 else None
