"""What a detector on board tells its agent: which targets it sees, where, and how they move.

A detector is any program on the agent's computer. It puts JSON on `swarm/@v1/<mission>/sight/<uid>`, for each picture:

    {"at_s": 1764113400.25, "targets": [
        {"target": 3, "east_m": 12.1, "north_m": -4.0, "east_m_s": 0.3, "north_m_s": 0.0}]}

`at_s` is when it was taken, in seconds since 1970 (UTC). Places are meters east and north of the mission's home,
velocities m/s (0 where they are left out). Which target is which is for the detector to say: numbers from 0, below the
mission's count. What it says holds until it says something else, for SIGHT_LIVES_S at most, and is moved on by its
velocity; an empty list is nobody in sight.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Annotated

import msgspec

from comms.keys import Keys
from comms.messages import FARTHEST_M, FASTEST_M_S, Sighting
from comms.session import Bus

SIGHT_LIVES_S = 0.5
EARLY_S = 0.1  # it is the same computer's clock
MAX_BYTES = 65_536
MAX_TARGETS_SEEN = 256
MAX_WAITING = 16

_Place = Annotated[float, msgspec.Meta(ge=-FARTHEST_M, le=FARTHEST_M)]
_Speed = Annotated[float, msgspec.Meta(ge=-FASTEST_M_S, le=FASTEST_M_S)]


class SeenTarget(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One target in a picture: meters from home, and meters a second."""

    target: Annotated[int, msgspec.Meta(ge=0)]
    east_m: _Place
    north_m: _Place
    east_m_s: _Speed = 0.0
    north_m_s: _Speed = 0.0


class Sight(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One picture: when it was taken (UTC, s since 1970), and all that is seen in it."""

    at_s: Annotated[float, msgspec.Meta(ge=0.0, le=1e11)]
    targets: Annotated[tuple[SeenTarget, ...], msgspec.Meta(max_length=MAX_TARGETS_SEEN)]


@dataclass(slots=True)
class SightCount:
    """What detectors have said so far: taken in, or refused, because it is nothing that one says, or not of now."""

    accepted: int = 0
    bad: int = 0
    untimely: int = 0


class Eyes:
    """Agent `uid`'s side of it: the newest picture, as it is now.

    Args:
        n_targets: how many the mission has.
    """

    def __init__(self, bus: Bus, *, keys: Keys, uid: int, n_targets: int) -> None:
        self.count = SightCount()
        self._n_targets = n_targets
        self._arrived: deque[bytes] = deque(maxlen=MAX_WAITING)
        self._newest: Sight | None = None
        bus.subscribe(keys.sight(uid), self._hear)

    def see(self, utc_s: float) -> tuple[Sighting, ...]:
        """What is in sight at this time. Never raises on what arrived."""
        while self._arrived:
            self._take(self._arrived.popleft(), utc_s)
        sight = self._newest
        if sight is None or utc_s - sight.at_s > SIGHT_LIVES_S:
            return ()
        age_s = utc_s - sight.at_s
        return tuple(
            Sighting(seen.target, seen.east_m + age_s * seen.east_m_s, seen.north_m + age_s * seen.north_m_s)
            for seen in sight.targets
        )

    def _hear(self, key: str, payload: bytes) -> None:
        self._arrived.append(payload if len(payload) <= MAX_BYTES else b"")

    def _take(self, payload: bytes, utc_s: float) -> None:
        sight = decode_sight(payload, n_targets=self._n_targets)
        if sight is None:
            self.count.bad += 1
        elif not -EARLY_S <= utc_s - sight.at_s <= SIGHT_LIVES_S or self._is_older(sight):
            self.count.untimely += 1
        else:
            self.count.accepted += 1
            self._newest = sight

    def _is_older(self, sight: Sight) -> bool:
        return self._newest is not None and sight.at_s < self._newest.at_s


def decode_sight(wire: bytes, *, n_targets: int) -> Sight | None:
    """The sight in `wire`, or None if it is anything else, or of targets that there are not."""
    if len(wire) > MAX_BYTES:
        return None
    try:
        sight = msgspec.json.decode(wire, type=Sight)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return None
    return sight if all(seen.target < n_targets for seen in sight.targets) else None
