"""What every daemon is told beside its mission."""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256

from comms.credentials import Credentials
from comms.status import Level
from missions.mission import Mission

# zenoh's own port, on this machine alone.
ENDPOINT = "tcp/127.0.0.1:7447"
JOIN_S = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DaemonOptions:
    """Options of every daemon.

    Attributes:
        endpoint: where the world listens, as zenoh writes it. join_s: how long to wait for each other at the start.
        lockstep: whether nothing may be dropped, because everybody waits for everybody.
        log_level: the least that is said. leash: end when standard input does.
        credentials: what proves who it is; None: anybody may come in.
    """

    endpoint: str = ENDPOINT
    join_s: float = JOIN_S
    lockstep: bool = True
    log_level: Level = Level.INFO
    leash: bool = False
    credentials: Credentials | None = None


def fingerprint(mission: Mission) -> str:
    """The same for two processes if they were given the same mission."""
    return sha256(mission.model_dump_json().encode()).hexdigest()[:16]
