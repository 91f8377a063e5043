"""What a mission observes: simulated targets, or recorded tracks."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from missions.mission.part import Allowed, NonNegative, Part, Positive, tag_by


class TargetDeployment(Part):
    """Where targets start: at random places in a circle about home."""

    radius_m: Positive = 15.0
    """Radius of the circle in which targets start."""


class MovingTargets(Part):
    """Simulated targets."""

    motion: Literal["evasive", "random", "static"] = "evasive"
    """How they move: `evasive` flee from agents they notice, `random` walk and turn by chance, `static` stand still."""
    count: Annotated[int, Field(ge=1, le=1000)] = 10
    """How many."""
    speed_m_s: Positive = 0.3
    """Speed of targets that move."""
    sensing_range_m: float | None = Field(default=None, gt=0)
    """How far an evasive target notices an agent; null: as far as any agent sees."""
    deployment: TargetDeployment = TargetDeployment()
    """Where targets start."""


class TrackTargets(Part):
    """Targets that replay recorded tracks."""

    motion: Literal["tracks"]
    """How they move: along recorded tracks."""
    file: Annotated[Path, Field(strict=False), Allowed("the path of a CSV of tracks (--set targets.file=PATH)")]
    """CSV of tracks (t, id, x, y or Movebank's columns; plain or .gz); a relative path starts at the mission file."""
    start_s: NonNegative = 0.0
    """Time in the recording at which the mission starts."""
    max_gap_s: Positive = 30.0
    """A target is absent between two fixes further apart than this."""


Targets = Annotated[
    Annotated[MovingTargets, Tag("moving")] | Annotated[TrackTargets, Tag("tracks")],
    Discriminator(tag_by("motion", {"evasive": "moving", "random": "moving", "static": "moving", "tracks": "tracks"})),
]
