"""The geofence of an agent: a polygon on the ground, and which of its sides are near.

Plain geometry in the mission's ENU plane, meters. A circle is a polygon with many sides, so that there is one kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, pi, sin
from typing import NamedTuple

Place = tuple[float, float]

CIRCLE_SIDES = 64  # its sides cut 0.12 % off the radius


class Wall(NamedTuple):
    """Something in the way: `distance_m` off, along the unit vector (east, north); negative: it has been passed."""

    east: float
    north: float
    distance_m: float


class Fence(NamedTuple):
    """A polygon that an agent must not leave.

    Attributes:
        corners_m: in order around it, either way; the last is joined to the first.
        core_m: a circle of this radius about the origin is inside; 0 if the origin is not.
    """

    corners_m: tuple[Place, ...]
    core_m: float


def polygon(corners_m: Sequence[Place]) -> Fence:
    """The fence with these corners."""
    corners = tuple(corners_m)
    core_m = min(hypot(*place) for place in _nearest_on_sides(corners, 0.0, 0.0))
    return Fence(corners, core_m if encloses(corners, 0.0, 0.0) else 0.0)


def circle(radius_m: float) -> Fence:
    """A circle about the origin."""
    angles = [2.0 * pi * side / CIRCLE_SIDES for side in range(CIRCLE_SIDES)]
    return polygon([(radius_m * cos(angle), radius_m * sin(angle)) for angle in angles])


def encloses(corners_m: Sequence[Place], x: float, y: float) -> bool:
    """Whether (x, y) is inside: a ray to the east crosses the sides an odd number of times."""
    inside = False
    for (ax, ay), (bx, by) in _sides(corners_m):
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            inside = not inside
    return inside


def walls(fence: Fence, x: float, y: float, *, reach_m: float) -> list[Wall]:
    """The sides within `reach_m` of (x, y), each by its nearest point; from outside, the way out alone."""
    if hypot(x, y) + reach_m < fence.core_m:
        return []
    found = []
    for px, py in _nearest_on_sides(fence.corners_m, x, y):
        distance_m = hypot(px - x, py - y)
        if distance_m > 0.0:
            found.append(Wall((px - x) / distance_m, (py - y) / distance_m, distance_m))
    if encloses(fence.corners_m, x, y):
        return [wall for wall in found if wall.distance_m <= reach_m]
    if not found:
        return []
    back = min(found, key=lambda wall: wall.distance_m)
    return [Wall(-back.east, -back.north, -back.distance_m)]


def _sides(corners_m: Sequence[Place]) -> zip[tuple[Place, Place]]:
    return zip(corners_m, (*corners_m[1:], corners_m[0]), strict=True)


def _nearest_on_sides(corners_m: Sequence[Place], x: float, y: float) -> list[Place]:
    """The point of every side that is nearest to (x, y)."""
    points = []
    for (ax, ay), (bx, by) in _sides(corners_m):
        dx, dy = bx - ax, by - ay
        length2 = dx * dx + dy * dy
        share = min(max(((x - ax) * dx + (y - ay) * dy) / length2, 0.0), 1.0) if length2 > 0.0 else 0.0
        points.append((ax + share * dx, ay + share * dy))
    return points
