"""How a mission is launched: what is the launch's and not the mission's."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isinf
from pathlib import Path

from comms.credentials import Credentials
from missions.mission import Mission
from missions.problems import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Board:
    """Where people speak to a mission that flies in one process.

    Attributes:
        endpoint: where it listens, as zenoh writes it. is_required: without it the mission does not fly.
        credentials: what proves who it is, to whom it knows alone; None: anybody may come in.
    """

    endpoint: str
    is_required: bool = False
    credentials: Credentials | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class LaunchOptions:
    """Options of `swarm launch`. None of them changes what happens in a mission, only how fast and what is kept.

    Attributes:
        speed: mission seconds per second of wall time; `inf` is as fast as the computer can.
        record: the rerun recording to write, if any.
        report: the JSON report to write, if any; `-` is standard output.
        tlog: the folder for a telemetry log of each link, if any.
        view: whether to open a viewer. web: whether to serve one to browsers on this machine.
        board: where people speak to it, if they may.
        gcs: URLs of ports for ground stations, the whole swarm on each. gcs_key: what they sign with, if they must.
    """

    speed: float = inf
    record: Path | None = None
    report: str | None = None
    tlog: Path | None = None
    view: bool = False
    web: bool = False
    board: Board | None = None
    gcs: tuple[str, ...] = ()
    gcs_key: bytes | None = None

    @property
    def is_recorded(self) -> bool:
        """Whether somebody looks on who wants to see all of it."""
        return self.record is not None or self.view or self.web


def speed_of(mission: Mission, asked: float | None) -> float:
    """How fast to fly: as asked, or else as fast as it goes. A vehicle elsewhere, simulated or not, has its own clock.

    Raises:
        InputError: another speed than 1 was asked for such a vehicle.
    """
    if not mission.in_real_time:
        return inf if asked is None else asked
    if asked not in (None, 1.0):
        got = "max" if isinf(asked) else f"{asked:g}"
        raise InputError(f"--speed: got {got}; allowed: 1: the vehicles behind vehicle.links fly in real time")
    return 1.0
