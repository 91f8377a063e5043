"""One recording, read and counted: everything a review shows is made from this."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

from missions.metrics import Metrics
from missions.recording.playback import Playback, play_back
from missions.report import Report, report_of
from missions.review.calls import Call, calls_of
from missions.review.losses import Loss, losses_of
from missions.review.timeline import Line, timeline_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Review:
    """A mission as its recording tells it.

    Attributes:
        report: what the mission itself reported, but for wall times. complete: it lasted its whole duration.
        began_s: mission clock at the beginning of MISSION; None if it never began.
    """

    playback: Playback
    report: Report
    complete: bool
    began_s: float | None
    calls: Sequence[Call]
    losses: Sequence[Loss]
    lines: Sequence[Line]


def read(path: Path) -> Review:
    """Read a recording, repaired if need be.

    Raises:
        InputError: there is no such file, or it is no recording of a mission.
    """
    playback = play_back(path)
    observations, facts = playback.observations, playback.facts
    metrics = Metrics()
    for seen in observations:
        metrics.observe(seen)
    # As they were recorded, with every default: this version need not know all of them.
    settings: dict[str, Any] = YAML(typ="safe", pure=True).load(playback.mission_yaml)
    calls = calls_of(observations)
    flyers = settings["agents"]
    losses = losses_of(observations, calls, speed_m_s=flyers["speed_m_s"], sensing_range_m=flyers["sensing"]["range_m"])
    began = [seen.time_s for seen in observations if seen.mission_tick == 0]
    return Review(
        playback=playback,
        report=report_of(facts, metrics, wall_s=None, clock_s=observations[-1].time_s, recording=path),
        complete=metrics.ticks >= round(settings["duration_s"] / facts.tick_s),
        began_s=began[0] if began else None,
        calls=calls,
        losses=losses,
        lines=timeline_of(observations, calls, losses),
    )
