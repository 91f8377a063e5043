"""The area of interest S, which everybody in a mission knows: a disc or a rectangle about the local origin.

Plain scalar functions of (arena, x, y), inside what numba compiles; meters, the mission's ENU plane.
"""

from __future__ import annotations

from enum import IntEnum
from math import pi, sqrt
from typing import NamedTuple


class Shape(IntEnum):
    """What the arena looks like from above."""

    DISC = 0
    RECTANGLE = 1


class Arena(NamedTuple):
    """The area of interest, centered on the origin.

    Attributes:
        shape: a `Shape` value.
        half_x_m, half_y_m: half the extent east and north; both are the radius of a disc.
    """

    shape: int
    half_x_m: float
    half_y_m: float


def disc(radius_m: float) -> Arena:
    """A disc of `radius_m` about the origin."""
    return Arena(int(Shape.DISC), radius_m, radius_m)


def rectangle(width_m: float, height_m: float) -> Arena:
    """A rectangle, `width_m` east-west by `height_m` north-south, about the origin."""
    return Arena(int(Shape.RECTANGLE), width_m / 2, height_m / 2)


def area_m2(arena: Arena) -> float:
    """The arena's area."""
    factor = pi if arena.shape == Shape.DISC else 4.0
    return factor * arena.half_x_m * arena.half_y_m


def edge_distance_m(arena: Arena, x: float, y: float) -> float:
    """How far (x, y) is inside the edge; negative outside."""
    if arena.shape == Shape.DISC:
        return arena.half_x_m - sqrt(x * x + y * y)
    return min(arena.half_x_m - abs(x), arena.half_y_m - abs(y))


def clamped(arena: Arena, x: float, y: float) -> tuple[float, float]:
    """The point of the arena nearest to (x, y)."""
    if arena.shape == Shape.DISC:
        r = sqrt(x * x + y * y)
        if r <= arena.half_x_m:
            return x, y
        return x * arena.half_x_m / r, y * arena.half_x_m / r
    return (
        min(max(x, -arena.half_x_m), arena.half_x_m),
        min(max(y, -arena.half_y_m), arena.half_y_m),
    )


def outward_normal(arena: Arena, x: float, y: float) -> tuple[float, float]:
    """The unit vector out of the arena across the edge nearest to (x, y); (1, 0) at the very center."""
    if arena.shape == Shape.DISC:
        r = sqrt(x * x + y * y)
        if r < 1e-9:
            return 1.0, 0.0
        return x / r, y / r
    if arena.half_x_m - abs(x) <= arena.half_y_m - abs(y):
        return (1.0, 0.0) if x >= 0.0 else (-1.0, 0.0)
    return (0.0, 1.0) if y >= 0.0 else (0.0, -1.0)


def reflected(arena: Arena, x: float, y: float, ux: float, uy: float) -> tuple[float, float]:
    """Heading (ux, uy) mirrored at the edge nearest to (x, y) if it points outward there, else unchanged."""
    nx, ny = outward_normal(arena, x, y)
    out = ux * nx + uy * ny
    if out <= 0.0:
        return ux, uy
    return ux - 2.0 * out * nx, uy - 2.0 * out * ny
