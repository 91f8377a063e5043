"""What every daemon is told beside its mission."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import sha256
from math import inf, isinf
from pathlib import Path

from comms.credentials import Credentials
from comms.endpoint import is_local
from comms.status import Level
from missions.mission import Mission

# zenoh's own port, on this machine alone.
ENDPOINT = "tcp/127.0.0.1:7447"
ENDPOINTS = f"tcp/ADDRESS:PORT, such as {ENDPOINT}"
JOIN_S = 60.0
# A world on this computer that is gone for so long has ended, and it is not we who were too busy to keep in touch.
ENDED_S = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DaemonOptions:
    """Options of every daemon.

    Attributes:
        endpoint: where the world listens, as zenoh writes it. join_s: how long to wait for each other at the start.
        speed: mission seconds per second of wall time; `inf` is as fast as it goes.
        log_level: the least that is said. leash: end when standard input does.
        credentials: what proves who it is; None: anybody may come in.
        tlog: the folder for a log of each link to a vehicle, if any. tlog_began_unix_s: when the mission clock was 0
        in these logs; None: such that what comes first comes now.
    """

    endpoint: str = ENDPOINT
    join_s: float = JOIN_S
    speed: float = inf
    log_level: Level = Level.INFO
    leash: bool = False
    credentials: Credentials | None = None
    tlog: Path | None = None
    tlog_began_unix_s: float | None = None

    @property
    def lockstep(self) -> bool:
        """Whether nothing may be dropped, because everybody waits for everybody."""
        return isinf(self.speed)


def await_world_s(mission: Mission, options: DaemonOptions) -> float:
    """How long (wall clock) a world that has gone is waited for: elsewhere it may be the link that was cut."""
    return ENDED_S if is_local(options.endpoint) else mission.agents.world_timeout_s


def await_back_s(mission: Mission, options: DaemonOptions) -> float:
    """How long (wall clock) the world thinks that who was lost may be back: as long as an agent waits for the world."""
    if is_local(options.endpoint):
        return 0.0
    return mission.agents.world_timeout_s / (1.0 if options.lockstep else options.speed)


def fingerprint(mission: Mission, speed: float) -> str:
    """The same for two processes if they were given the same mission, and the same pace: both must be the world's.

    Files count by what is in them: on another computer they lie elsewhere. A signing key is each computer's own affair.
    """
    vehicle = mission.vehicle.model_copy(update={"signing_key": None})
    told = _by_content(mission.model_copy(update={"vehicle": vehicle}).model_dump())
    return sha256(f"{told} {speed}".encode()).hexdigest()[:16]


def _by_content(value: object) -> object:
    if isinstance(value, Mapping):
        return {key: _by_content(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_by_content(part) for part in value]
    if isinstance(value, Path):
        return sha256(value.read_bytes()).hexdigest() if value.is_file() else value.name
    return value
