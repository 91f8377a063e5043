"""Where uploaded fences let a vehicle be: polygons and circles on the ground, to stay in and to stay out of."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import hypot
from typing import NamedTuple

from comms.frames import Vec3
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.plans.store import FenceCommand

POLYGONS = (FenceCommand.POLYGON_INCLUSION, FenceCommand.POLYGON_EXCLUSION)
INCLUSIONS = (FenceCommand.POLYGON_INCLUSION, FenceCommand.CIRCLE_INCLUSION)

Place = tuple[float, float]  # north, east, meters


class Polygon(NamedTuple):
    """Its corners in order; the last is joined to the first."""

    corners: tuple[Place, ...]

    def holds(self, place: Place) -> bool:
        """Whether `place` is inside: a ray to the east crosses the border an odd number of times."""
        north, east = place
        inside = False
        for (n1, e1), (n2, e2) in pairwise((*self.corners, self.corners[0])):
            if (n1 > north) != (n2 > north) and east < e1 + (north - n1) * (e2 - e1) / (n2 - n1):
                inside = not inside
        return inside


class Circle(NamedTuple):
    center: Place
    radius_m: float

    def holds(self, place: Place) -> bool:
        return hypot(place[0] - self.center[0], place[1] - self.center[1]) <= self.radius_m


class Outline(NamedTuple):
    """All uploaded fences. A place is allowed inside every inclusion and outside every exclusion."""

    inside: tuple[Polygon | Circle, ...] = ()
    outside: tuple[Polygon | Circle, ...] = ()

    def allows(self, north_m: float, east_m: float) -> bool:
        place = (north_m, east_m)
        return all(zone.holds(place) for zone in self.inside) and not any(zone.holds(place) for zone in self.outside)


def outline(items: tuple[Item, ...], ned_from_item: Callable[[Item], Vec3]) -> Outline:
    """The fences of a stored plan, whose polygons are whole."""
    inside: list[Polygon | Circle] = []
    outside: list[Polygon | Circle] = []
    index = 0
    while index < len(items):
        item = items[index]
        corners = int(item.param1) if item.command in POLYGONS else 1
        places = tuple(ned_from_item(corner)[:2] for corner in items[index : index + corners])
        index += corners
        if item.command != FenceCommand.RETURN_POINT:
            zone = Polygon(places) if item.command in POLYGONS else Circle(places[0], item.param1)
            (inside if item.command in INCLUSIONS else outside).append(zone)
    return Outline(tuple(inside), tuple(outside))
