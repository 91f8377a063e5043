"""Where agents and targets stand at the start: scattered over a disc, the same for the same seed."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

from comms.chance import START_HEADING, draw

TRIES = 1000


def scatter(
    *, count: int, radius_m: float, spacing_m: float, seed: int, purpose: int
) -> tuple[tuple[float, float], ...]:
    """`count` points, uniform over the disc of `radius_m` about the origin, no two nearer than `spacing_m`.

    PAPER: the paper places robots with no minimum distance; drones cannot stand in each other on the ground.

    Raises:
        ValueError: if the disc is too full for that spacing.
    """
    points: list[tuple[float, float]] = []
    for who in range(count):
        for attempt in range(TRIES):
            r = radius_m * sqrt(draw(seed, 2 * attempt, who, purpose))
            angle = 2.0 * pi * draw(seed, 2 * attempt + 1, who, purpose)
            x, y = r * cos(angle), r * sin(angle)
            if all((x - a) * (x - a) + (y - b) * (y - b) >= spacing_m * spacing_m for a, b in points):
                points.append((x, y))
                break
        else:
            raise ValueError(f"no room for {count} places {spacing_m:g} m apart within {radius_m:g} m")
    return tuple(points)


def heading(*, who: int, seed: int, purpose: int) -> tuple[float, float]:
    """A unit vector in a random direction, for number `who` of the kind that `purpose` places."""
    angle = 2.0 * pi * draw(seed, purpose, who, START_HEADING)
    return cos(angle), sin(angle)
