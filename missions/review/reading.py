"""One recording, read and counted: everything a review shows is made from this."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from comms.arena import Arena, disc, rectangle
from missions.faults.costs import Costs
from missions.metrics import Metrics
from missions.mission.faults import AnyFault, Faults
from missions.observation import Observation
from missions.problems import InputError
from missions.recording.playback import Playback, play_back
from missions.report import Report, report_of
from missions.review.calls import Call, calls_of
from missions.review.losses import Loss, losses_of
from missions.review.timeline import Line, timeline_of
from missions.review.words import clock

_ROUNDING_S = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Review:
    """A mission as its recording tells it.

    Attributes:
        report: what the mission itself reported, but for wall times. complete: it lasted its whole duration.
        settings: the mission file, with every default, as it was recorded. arena, sensing_range_m: from there.
        unknown_faults: its faults on purpose are none that this version knows.
        began_s: mission clock at the beginning of MISSION; None if it never began.
    """

    playback: Playback
    report: Report
    complete: bool
    settings: Mapping[str, Any]
    arena: Arena
    sensing_range_m: float
    began_s: float | None
    unknown_faults: bool
    calls: Sequence[Call]
    losses: Sequence[Loss]
    lines: Sequence[Line]

    @property
    def notes(self) -> list[str]:
        """What one must know to read the numbers: the recording is torn, or ticks are missing."""
        notes = []
        if self.playback.torn:
            end = clock(self.playback.observations[-1].time_s)
            notes.append(
                "The recording is not finished: its mission flies still, or its recorder was killed. "
                f"A copy was repaired to be read, and ends at {end}."
            )
        if self.unknown_faults:
            notes.append("Its faults on purpose are told in words of another version: what they cost is not counted.")
        if self.playback.ticks_missing:
            notes.append(f"{self.playback.ticks_missing} ticks are missing: what is counted is counted without them.")
        return notes

    def at(self, time_s: float) -> Observation:
        """The last tick that began by then (mission clock); the first one before that."""
        observations = self.playback.observations
        count = bisect_right(observations, time_s + _ROUNDING_S, key=lambda seen: seen.time_s)
        return observations[max(0, count - 1)]


def read(path: Path) -> Review:
    """Read a recording, repaired if need be.

    Raises:
        InputError: there is no such file, or it is no recording of a mission.
    """
    playback = play_back(path)
    try:
        return _read(playback)
    except (LookupError, TypeError, ValueError, AttributeError, YAMLError) as error:
        raise InputError(
            f"{path}: got a mission that this version does not understand ({type(error).__name__}: {error}); "
            "allowed: what its swarm launch --record wrote"
        ) from error


def _read(playback: Playback) -> Review:
    observations, facts = playback.observations, playback.facts
    # Read leniently: another version may have written keys that this one does not know.
    settings: Mapping[str, Any] = YAML(typ="safe", pure=True).load(playback.mission_yaml)
    faults = _faults(settings.get("faults", []))
    metrics = Metrics(costs=Costs(faults or (), tick_s=facts.tick_s))
    for seen in observations:
        metrics.observe(seen)
    range_m, speed_m_s = settings["agents"]["sensing"]["range_m"], settings["agents"]["speed_m_s"]
    calls = calls_of(observations)
    losses = losses_of(observations, calls, speed_m_s=speed_m_s, sensing_range_m=range_m)
    flown = [seen for seen in observations if seen.mission_tick is not None]
    # By the last tick's number: a real-time recording may lack some in between.
    last_tick = -1 if not flown else flown[-1].mission_tick or 0
    return Review(
        playback=playback,
        report=report_of(facts, metrics, wall_s=None, clock_s=observations[-1].time_s, recording=playback.path),
        complete=last_tick + 1 >= round(settings["duration_s"] / facts.tick_s),
        settings=settings,
        arena=_arena(settings["arena"]),
        sensing_range_m=range_m,
        began_s=flown[0].time_s if flown else None,
        unknown_faults=faults is None,
        calls=calls,
        losses=losses,
        lines=timeline_of(observations, calls, losses),
    )


def _faults(settings: Any) -> tuple[AnyFault, ...] | None:
    """The faults on purpose; None when they are none that this version knows."""
    try:
        return TypeAdapter[tuple[AnyFault, ...]](Faults).validate_python(settings)
    except ValidationError:
        return None


def _arena(settings: Mapping[str, Any]) -> Arena:
    if settings["shape"] == "disc":
        return disc(settings["radius_m"])
    return rectangle(settings["width_m"], settings["height_m"])
