"""What every agent of a mission keeps to: the fence, the ceiling, the distance, the battery's reserve."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from missions.mission.part import Allowed, Extent, Part, tag_by

Reach = Annotated[float, Field(ge=-50_000, le=50_000)]
CORNERS = "a list of 3 to 64 corners [east, north], each number from -50000 to 50000"


class ArenaFence(Part):
    """A geofence around the arena."""

    shape: Literal["arena"] = "arena"
    """The fence's shape: the arena's, and wider."""
    margin_m: Annotated[float | None, Field(ge=0, le=10_000)] = None
    """How far beyond the arena it runs; null: as far as an agent needs to stop, and 10 m more."""


class CircleFence(Part):
    """A round geofence, centered on home."""

    shape: Literal["circle"]
    """The fence's shape."""
    radius_m: Extent = 60.0
    """Its radius."""


class PolygonFence(Part):
    """A geofence with corners."""

    shape: Literal["polygon"]
    """The fence's shape."""
    corners_m: Annotated[
        tuple[Annotated[tuple[Reach, Reach], Field(strict=False)], ...],
        Field(strict=False, min_length=3, max_length=64),
        Allowed(CORNERS),
    ]
    """Its corners in order, each meters east and north of home."""


FenceShape = Annotated[
    Annotated[ArenaFence, Tag("arena")]
    | Annotated[CircleFence, Tag("circle")]
    | Annotated[PolygonFence, Tag("polygon")],
    Discriminator(tag_by("shape", {"arena": "arena", "circle": "circle", "polygon": "polygon"})),
]


class Safety(Part):
    """What every agent keeps to, whatever its policy wants."""

    fence: FenceShape = ArenaFence()
    """What no agent flies out of."""
    ceiling_m: Annotated[float, Field(gt=0, le=500)] = 500.0
    """No layer is higher above home."""
    separation_m: Annotated[float, Field(ge=0, le=1000)] = 2.0
    """Least horizontal distance between agents that share a layer; ideal vehicles, being points, do not keep it."""
    battery_reserve: Annotated[float, Field(ge=0, lt=1)] = 0.2
    """An agent comes home when its battery has this share left, or its autopilot says that it is low; not if ideal."""
