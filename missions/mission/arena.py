"""Where a mission takes place: the arena, and its home on the globe."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from comms.arena import Arena as Area
from comms.arena import disc, rectangle
from comms.frames import GeoPoint
from missions.mission.part import Extent, Part, tag_by


class Disc(Part):
    """A round arena, centered on home."""

    shape: Literal["disc"] = "disc"
    """The arena's shape."""
    radius_m: Extent = 30.0
    """Radius of the disc."""

    @property
    def area(self) -> Area:
        """The arena as the world and the agents know it."""
        return disc(self.radius_m)


class Rectangle(Part):
    """A rectangular arena, centered on home."""

    shape: Literal["rectangle"]
    """The arena's shape."""
    width_m: Extent = 60.0
    """Extent from west to east."""
    height_m: Extent = 60.0
    """Extent from south to north."""

    @property
    def area(self) -> Area:
        """The arena as the world and the agents know it."""
        return rectangle(self.width_m, self.height_m)


Arena = Annotated[
    Annotated[Disc, Tag("disc")] | Annotated[Rectangle, Tag("rectangle")],
    Discriminator(tag_by("shape", {"disc": "disc", "rectangle": "rectangle"})),
]


class Home(Part):
    """Where on the globe the local origin lies (WGS84)."""

    # The local plane is a tangent plane: it has no east at the poles.
    latitude_deg: Annotated[float, Field(ge=-85, le=85)] = -35.363262
    """Degrees north of the equator."""
    longitude_deg: Annotated[float, Field(ge=-180, le=180)] = 149.165237
    """Degrees east of Greenwich."""
    altitude_m: Annotated[float, Field(ge=-500, le=9000)] = 584.0
    """Height of the ground above mean sea level."""

    @property
    def place(self) -> GeoPoint:
        """The local origin on the globe."""
        return GeoPoint(self.latitude_deg, self.longitude_deg, self.altitude_m)
