"""The still parts of a recording: names, ids, geometry, camera, colors."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from math import pi, tan

import numpy as np
import pytest

from comms.arena import Arena, area_m2, disc, edge_distance_m, rectangle
from comms.status import Activity, Level
from missions.recording import palette, shapes
from missions.recording.columns import faded, ramp
from missions.recording.eye import fitting_eye
from tests.missions.toy_observations import toy_scene

ARENAS = [disc(30.0), rectangle(1500.0, 1500.0), rectangle(800.0, 400.0), rectangle(50.0, 300.0)]


@pytest.mark.parametrize("arena", ARENAS)
def test_the_ground_covers_the_arena(arena: Arena) -> None:
    vertices, triangles = shapes.ground_mesh(arena)
    a, b, c = (vertices[triangles[:, corner]].astype(np.float64) for corner in range(3))
    signed = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    # Every triangle faces up, and together they fill the arena; a disc loses what its polygon cuts off.
    assert signed.min() >= -1e-3 * signed.mean()
    assert signed.sum() == pytest.approx(area_m2(arena), rel=2e-3)
    rows, columns = shapes.ground_shape(arena)
    assert len(vertices) == rows * columns


@pytest.mark.parametrize("arena", ARENAS)
def test_nothing_is_drawn_outside_the_arena(arena: Arena) -> None:
    vertices, _ = shapes.ground_mesh(arena)
    points = np.concatenate((vertices, shapes.edge_line(arena), shapes.grid_lines(arena).reshape(-1, 2)))
    slack = 1e-4 * max(arena.half_x_m, arena.half_y_m)
    assert all(edge_distance_m(arena, x, y) > -slack for x, y in points.tolist())


def test_a_disc_is_covered_evenly() -> None:
    vertices, triangles = shapes.ground_mesh(disc(30.0))
    middles = vertices[triangles].mean(axis=1)
    inner = np.hypot(*middles.T) < 15.0
    assert inner.mean() == pytest.approx(0.25, abs=0.01)


@pytest.mark.parametrize(("half", "spacing"), [(30.0, 5.0), (150.0, 20.0), (750.0, 100.0), (6.0, 1.0)])
def test_the_grid_has_round_spacing(half: float, spacing: float) -> None:
    assert shapes.grid_spacing_m(rectangle(2 * half, 2 * half)) == spacing


def test_a_compass_heading_is_clockwise_from_north() -> None:
    east_north_up = shapes.compass(np.array([0.0, pi / 2, pi, -pi / 2], dtype=np.float32))
    assert east_north_up == pytest.approx(np.array([(0, 1, 0), (1, 0, 0), (0, -1, 0), (-1, 0, 0)]), abs=1e-6)


@pytest.mark.parametrize("arena", ARENAS)
@pytest.mark.parametrize("ceiling_m", [0.0, 40.0])
def test_the_camera_has_the_whole_arena_in_the_picture(arena: Arena, ceiling_m: float) -> None:
    scene = replace(toy_scene(arena=arena), ceiling_m=ceiling_m)
    position, target = (np.array(point) for point in fitting_eye(scene))
    ahead = (target - position) / np.linalg.norm(target - position)
    right = np.array((1.0, 0.0, 0.0))
    up = np.cross(right, ahead)
    edge = shapes.edge_line(arena)
    for share, height in ((1.0, 0.0), (0.75, ceiling_m)):
        seen = np.column_stack((share * edge, np.full(len(edge), height))) - position
        depth = seen @ ahead
        assert depth.min() > 0
        assert np.abs(seen @ up / depth).max() < tan(pi * 55 / 360)
        assert np.abs(seen @ right / depth).max() < 1.65 * tan(pi * 55 / 360)


def test_equal_scenes_share_an_id_and_others_do_not() -> None:
    scene = toy_scene(seed=1)
    assert scene.recording_id == toy_scene(seed=1).recording_id
    others = [toy_scene(seed=2), replace(scene, policy="random"), replace(scene, arena=disc(150.0))]
    assert len({scene.recording_id, *(other.recording_id for other in others)}) == 4


def test_each_activity_has_its_own_color() -> None:
    assert set(palette.ACTIVITY_COLORS) == set(Activity)
    assert len(set(palette.ACTIVITY_COLORS.values())) == len(Activity)
    assert len(set(palette.ACTIVITY_INKS.values())) == len(Activity) == len(palette.ACTIVITY_INKS)
    assert set(palette.LEVEL_INKS) == set(Level)


@pytest.mark.parametrize(
    "ink", [*palette.ACTIVITY_INKS.values(), *palette.LEVEL_INKS.values(), *palette.series_colors(10)]
)
def test_inks_are_read_on_black_and_on_white(ink: int) -> None:
    # WCAG 2.2, "contrast ratio": 3 is asked of graphics and of large text.
    channels = (np.array([ink >> 24, ink >> 16 & 0xFF, ink >> 8 & 0xFF]) / 255).tolist()
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    luminance = np.dot((0.2126, 0.7152, 0.0722), linear)
    assert 1.05 / (luminance + 0.05) > 3.0
    assert (luminance + 0.05) / 0.05 > 4.5


def test_ramps_run_from_color_to_color() -> None:
    assert ramp(0x000000FF, 0x040800FF, 5).tolist() == [0x000000FF, 0x010200FF, 0x020400FF, 0x030600FF, 0x040800FF]
    assert faded(np.array([0x12345678], dtype=np.uint32), 0xFF).tolist() == [0x123456FF]


def test_without_rerun_the_error_names_the_extra() -> None:
    code = "import sys; sys.modules['rerun'] = None; import missions.recording"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.returncode == 1
    assert "recording needs rerun, which the `ground` extra installs: pip install '.[ground]'" in run.stderr
