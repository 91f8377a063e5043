"""Geometry that does not know what it is drawn for: the arena's ground mesh, edge and grid, and headings."""

from __future__ import annotations

from math import ceil, floor, log10, pi, sqrt

import numpy as np
import numpy.typing as npt

from comms.arena import Arena, Shape
from missions.recording.block import Floats

Triangles = npt.NDArray[np.uint32]

# Vertices of the ground mesh, about: fine enough for a smooth edge of what was seen, coarse enough for 1 Hz.
_GROUND_VERTICES = 3600


def ground_shape(arena: Arena) -> tuple[int, int]:
    """Rows and columns of the ground mesh's vertices."""
    slant = arena.half_y_m / arena.half_x_m
    return max(2, round(sqrt(_GROUND_VERTICES * slant))), max(2, round(sqrt(_GROUND_VERTICES / slant)))


def ground_mesh(arena: Arena) -> tuple[Floats, Triangles]:
    """Vertices (V, 2) spread evenly over the arena, row by row, and triangles (T, 3) between them.

    A disc is a square grid, bent: Shirley and Chiu's concentric map keeps areas, so that a vertex counts the same
    everywhere ("A low distortion map between disk and square", 1997).
    """
    rows, columns = ground_shape(arena)
    u, v = np.meshgrid(np.linspace(-1.0, 1.0, columns), np.linspace(-1.0, 1.0, rows))
    square = np.column_stack((u.ravel(), v.ravel()))
    unit = _disc_from_square(square) if arena.shape == Shape.DISC else square
    vertices = unit * (arena.half_x_m, arena.half_y_m)

    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    lower = np.column_stack((corner, corner + 1, corner + columns + 1))
    upper = np.column_stack((corner, corner + columns + 1, corner + columns))
    return vertices.astype(np.float32), np.concatenate((lower, upper)).astype(np.uint32)


def _disc_from_square(square: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    a, b = square[:, 0], square[:, 1]
    wide = np.abs(a) >= np.abs(b)
    radius = np.where(wide, a, b)
    other = np.where(wide, b, a)
    turn = (pi / 4) * np.divide(other, radius, out=np.zeros_like(other), where=radius != 0)
    angle = np.where(wide, turn, pi / 2 - turn)
    return np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))


def edge_line(arena: Arena) -> Floats:
    """The closed outline of the arena, (P, 2)."""
    if arena.shape == Shape.DISC:
        angle = np.linspace(0.0, 2 * pi, 145)
        unit = np.column_stack((np.cos(angle), np.sin(angle)))
    else:
        unit = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)], dtype=np.float64)
    return (unit * (arena.half_x_m, arena.half_y_m)).astype(np.float32)


def grid_spacing_m(arena: Arena) -> float:
    """A round distance, 1, 2 or 5 times a power of ten, of which about twelve cross the arena."""
    wanted = 2 * max(arena.half_x_m, arena.half_y_m) / 12
    power = 10.0 ** floor(log10(wanted))
    return min((step * power for step in (1, 2, 5, 10)), key=lambda spacing: abs(spacing - wanted))


def grid_lines(arena: Arena) -> Floats:
    """Lines through every multiple of `grid_spacing_m`, ending at the arena's edge: (L, 2, 2)."""
    spacing = grid_spacing_m(arena)
    lines = []
    for x in _multiples(spacing, arena.half_x_m):
        reach = _reach(arena, x, arena.half_y_m)
        lines.append(((x, -reach), (x, reach)))
    for y in _multiples(spacing, arena.half_y_m):
        reach = _reach(arena, y, arena.half_x_m)
        lines.append(((-reach, y), (reach, y)))
    return np.array(lines, dtype=np.float32).reshape(-1, 2, 2)


def _multiples(spacing: float, half: float) -> list[float]:
    """Multiples of `spacing` strictly between -half and half."""
    last = ceil(half / spacing) - 1
    return [number * spacing for number in range(-last, last + 1)]


def _reach(arena: Arena, off: float, half: float) -> float:
    """Half the length of a line that passes the center at distance `off`."""
    return sqrt(half**2 - off**2) if arena.shape == Shape.DISC else half


def compass(headings_rad: Floats) -> Floats:
    """Unit vectors (..., 3) east, north, up along headings clockwise from north, in steps of 3 degrees (they pack)."""
    steps = np.round(headings_rad * (60 / pi)) * (pi / 60)
    return np.stack((np.sin(steps), np.cos(steps), np.zeros_like(steps)), axis=-1).astype(np.float32)
