"""How a mission is launched: what is the launch's and not the mission's."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from pathlib import Path


@dataclass(frozen=True, slots=True, kw_only=True)
class LaunchOptions:
    """Options of `swarm launch`. None of them changes what happens in a mission, only how fast and what is kept.

    Attributes:
        speed: mission seconds per second of wall time; `inf` is as fast as the computer can.
        record: the rerun recording to write, if any.
        report: the JSON report to write, if any; `-` is standard output.
        view: whether to open a viewer.
    """

    speed: float = inf
    record: Path | None = None
    report: str | None = None
    view: bool = False
