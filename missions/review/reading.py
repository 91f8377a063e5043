"""One recording, read and counted: everything a review shows is made from this.

It is read once, tick by tick: what is kept grows with what happened, and by a few numbers a tick.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

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
from missions.review.calls import Call
from missions.review.figures.snapshots import Snapshot, Snapshots
from missions.review.lanes import Lanes
from missions.review.losses import Loss
from missions.review.series import Series
from missions.review.story import Story
from missions.review.timeline import Line
from missions.review.words import clock

_ROUNDING_S = 1e-6


class When(NamedTuple):
    """A moment of one agent, by the mission clock."""

    time_s: float
    agent: int


class Moment(NamedTuple):
    """All there is of it: the last tick that began by then, and what the agent told of its mind last, and when."""

    when: When
    seen: Observation
    page: tuple[int, str] | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Review:
    """A mission as its recording tells it.

    Attributes:
        report: what the mission itself reported, but for wall times. complete: it lasted its whole duration.
        settings: the mission file, with every default, as it was recorded. arena, sensing_range_m: from there.
        unknown_faults: its faults on purpose are none that this version knows.
        began_s, ended_s: mission clock at the beginning of MISSION (None if it never began), and at the last tick.
        lanes, series, snapshots, snapshots_flown: what is drawn over time, the last of MISSION alone.
        moment: the one that was asked for.
    """

    playback: Playback  # read to its end, and closed
    report: Report
    complete: bool
    settings: Mapping[str, Any]
    arena: Arena
    sensing_range_m: float
    began_s: float | None
    ended_s: float
    unknown_faults: bool
    calls: Sequence[Call]
    losses: Sequence[Loss]
    lines: Sequence[Line]
    lanes: Lanes
    series: Series
    snapshots: Sequence[Snapshot]
    snapshots_flown: Sequence[Snapshot]
    moment: Moment | None

    @property
    def notes(self) -> list[str]:
        """What one must know to read the numbers: the recording is not finished or damaged, or ticks are missing."""
        notes = []
        if self.playback.unfinished:
            notes.append(
                "The recording is not finished: its mission flies still, or its recorder was killed. "
                f"A copy was repaired to be read, and ends at {clock(self.ended_s)}."
            )
        if self.playback.damaged:
            places = "1 place" if self.playback.damaged == 1 else f"{self.playback.damaged} places"
            notes.append(f"The recording is damaged in {places}: what cannot be read there is left out.")
        if self.unknown_faults:
            notes.append("Its faults on purpose are told in words of another version: what they cost is not counted.")
        if self.playback.ticks_missing:
            notes.append(f"{self.playback.ticks_missing} ticks are missing: what is counted is counted without them.")
        return notes


def read(path: Path, *, moment: When | None = None) -> Review:
    """Read a recording, repaired if need be; of one moment all there is.

    Raises:
        InputError: there is no such file, or it is no recording of a mission.
    """
    with play_back(path) as playback:
        try:
            # Leniently: another version may have written keys that this one does not know.
            settings: Mapping[str, Any] = YAML(typ="safe", pure=True).load(playback.mission_yaml)
            return _read(playback, settings, moment)
        except InputError:
            raise
        except (LookupError, TypeError, ValueError, AttributeError, YAMLError) as error:
            raise InputError(
                f"{path}: got a mission that this version does not understand ({type(error).__name__}: {error}); "
                "allowed: what its swarm launch --record wrote"
            ) from error


def _read(playback: Playback, settings: Mapping[str, Any], when: When | None) -> Review:
    facts, faults = playback.facts, _faults(settings.get("faults", []))
    range_m, arena = settings["agents"]["sensing"]["range_m"], _arena(settings["arena"])
    metrics = Metrics(costs=Costs(faults or (), tick_s=facts.tick_s))
    story = Story(speed_m_s=settings["agents"]["speed_m_s"], sensing_range_m=range_m)
    series, snapshots, snapshots_flown = Series(), Snapshots(), Snapshots()
    looked_at = None
    for seen in playback.observations():
        for observer in (metrics, story, series, snapshots):
            observer.observe(seen)
        if seen.mission_tick is not None:
            snapshots_flown.observe(seen)
            last_tick = seen.mission_tick
        if when is not None and (looked_at is None or seen.time_s <= when.time_s + _ROUNDING_S):
            looked_at = seen
    return Review(
        playback=playback,
        report=report_of(facts, metrics, wall_s=None, clock_s=series.time_s[-1], recording=playback.path),
        # By the last tick's number: a real-time recording may lack some in between.
        complete=bool(series.flown_s) and last_tick + 1 >= round(settings["duration_s"] / facts.tick_s),
        settings=settings,
        arena=arena,
        sensing_range_m=range_m,
        began_s=series.flown_s[0] if series.flown_s else None,
        ended_s=series.time_s[-1],
        unknown_faults=faults is None,
        calls=story.calls,
        losses=story.losses,
        lines=story.lines,
        lanes=story.lanes,
        series=series,
        snapshots=snapshots.taken,
        snapshots_flown=snapshots_flown.taken,
        moment=None if when is None or looked_at is None else _moment(playback, when, looked_at),
    )


def _moment(playback: Playback, when: When, seen: Observation) -> Moment:
    known = 0 <= when.agent < playback.facts.agents
    return Moment(when, seen, playback.page(when.agent, seen.tick) if known else None)


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
