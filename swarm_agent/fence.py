"""The geofence of an agent: a polygon on the ground, and which of its sides are in the way.

Plain geometry in the mission's ENU plane, meters. A circle is a polygon with many sides, so that there is one kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, pi, sin
from typing import NamedTuple

Place = tuple[float, float]

CIRCLE_SIDES = 64  # its sides cut 0.12 % off the radius


class Wall(NamedTuple):
    """Something behind a line: `distance_m` off, along the unit vector (east, north); negative: it has been passed."""

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
    core_m = min(hypot(*_nearest(a, b, 0.0, 0.0)) for a, b in _sides(corners))
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
    """What is in the way within `reach_m` of (x, y): on this side of all of it is no side of the fence.

    From outside, the way out alone.
    """
    if hypot(x, y) + reach_m < fence.core_m:
        return []
    corners = fence.corners_m
    near = []
    for i, (a, b) in enumerate(_sides(corners)):
        px, py = _nearest(a, b, x, y)
        near.append((hypot(px - x, py - y), px, py, i))
    near.sort()
    if not encloses(corners, x, y):
        distance_m, px, py, _ = near[0]
        return [Wall((x - px) / distance_m, (y - py) / distance_m, -distance_m)] if distance_m > 0.0 else []
    found: list[Wall] = []
    for distance_m, px, py, i in near:
        if distance_m > reach_m:
            break
        before, a, b, after = (corners[(i + step) % len(corners)] for step in (-1, 0, 1, 2))
        if distance_m == 0.0 or any(_behind(wall, a, b, x, y) for wall in found):
            continue
        beyond = before if (px, py) == a else after if (px, py) == b else a
        found.append(_own_line(a, b, beyond, x, y) or Wall((px - x) / distance_m, (py - y) / distance_m, distance_m))
    return found


def _behind(wall: Wall, a: Place, b: Place, x: float, y: float) -> bool:
    """Whether the side from a to b is wholly behind the wall, seen from (x, y)."""
    far_m = min((a[0] - x) * wall.east + (a[1] - y) * wall.north, (b[0] - x) * wall.east + (b[1] - y) * wall.north)
    return far_m >= wall.distance_m


def _own_line(a: Place, b: Place, beyond: Place, x: float, y: float) -> Wall | None:
    """The line along the side from a to b, unless the fence goes on behind it at the end that is nearest to (x, y).

    There who flies past the end may cross the line.

    Args:
        beyond: the next corner past that end.
    """
    dx, dy = b[0] - a[0], b[1] - a[1]
    length_m = hypot(dx, dy)
    if length_m == 0.0:
        return None
    east, north = -dy / length_m, dx / length_m
    distance_m = (a[0] - x) * east + (a[1] - y) * north
    if distance_m < 0.0:
        east, north, distance_m = -east, -north, -distance_m
    goes_on_behind = (beyond[0] - a[0]) * east + (beyond[1] - a[1]) * north > 0.0
    return None if goes_on_behind else Wall(east, north, distance_m)


def _sides(corners_m: Sequence[Place]) -> zip[tuple[Place, Place]]:
    return zip(corners_m, (*corners_m[1:], corners_m[0]), strict=True)


def _nearest(a: Place, b: Place, x: float, y: float) -> Place:
    """The point of the side from a to b that is nearest to (x, y)."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    share = ((x - a[0]) * dx + (y - a[1]) * dy) / length2 if length2 > 0.0 else 0.0
    # The ends themselves, to the last bit.
    return a if share <= 0.0 else b if share >= 1.0 else (a[0] + share * dx, a[1] + share * dy)
