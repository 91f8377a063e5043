"""Where to stand to see the whole mission: a camera that fits the arena and the air above it into the picture."""

from __future__ import annotations

from math import cos, radians, sin, tan

import numpy as np
import numpy.typing as npt

from missions.recording import shapes
from missions.recording.columns import on_ground
from missions.recording.scene import Scene

Point = tuple[float, float, float]

# The viewer's own field of view, and the shape of the 3D view in the blueprint on a wide screen.
_HALF_HEIGHT = tan(radians(55.0) / 2)
_ASPECT = 1.65
_PITCH = radians(42.0)
_MARGIN = 1.04
_INNER = 0.75
_PLAN_MARGIN = 1.1

_AHEAD = np.array((0.0, cos(_PITCH), -sin(_PITCH)))
_UP = np.array((0.0, sin(_PITCH), cos(_PITCH)))


def fitting_eye(scene: Scene) -> tuple[Point, Point]:
    """Position and look target, ENU meters, of a camera in the south that looks down at 42 degrees.

    The look target slides along the picture's vertical to where the camera may come closest, or to the middle of such
    places when the width alone decides.
    """
    edge = on_ground(shapes.edge_line(scene.arena)).astype(np.float64)
    # Nobody flies high above the very edge for long.
    corners = np.concatenate((edge, _INNER * edge + np.array((0.0, 0.0, scene.ceiling_m))))
    slides = np.linspace(-1.0, 1.0, 201) * scene.size_m
    distances = np.array([_distance_m(corners - slide * _UP) for slide in slides])
    distance = distances.min()
    target = slides[distances <= 1.001 * distance].mean() * _UP
    return _point(target - distance * _AHEAD), _point(target)


def eye_above(scene: Scene) -> tuple[Point, Point]:
    """Position and look target of a camera high above the middle: a plan of the arena, north up, for a square view."""
    height_m = _PLAN_MARGIN * max(scene.arena.half_y_m, scene.arena.half_x_m) / _HALF_HEIGHT
    return (0.0, 0.0, height_m), (0.0, 0.0, 0.0)


def _distance_m(corners: npt.NDArray[np.float64]) -> float:
    """How far behind the origin the camera must stand to have every corner (P, 3) in the picture."""
    depth, up, right = corners @ _AHEAD, np.abs(corners @ _UP), np.abs(corners[:, 0])
    needed = np.maximum(up, right / _ASPECT) * (_MARGIN / _HALF_HEIGHT) - depth
    return float(needed.max())


def _point(vector: npt.NDArray[np.float64]) -> Point:
    x, y, z = vector.tolist()
    return (x, y, z)
