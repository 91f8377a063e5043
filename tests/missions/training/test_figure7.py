"""Figure 7 is drawn and written."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("matplotlib")

from missions.training.figure7 import points, write
from missions.training.weights import BUNDLED, read_weights


def test_points_are_triangles() -> None:
    cloud = points(read_weights(BUNDLED).pair.net, steps=4)
    assert len({point[:3] for point in cloud}) == len(cloud) > 40
    for v1, v2, v3, seconds in cloud:
        assert abs(v1 - v2) <= 2 * v3 <= v1 + v2
        assert 0.0 < seconds < 20.0


def test_both_files_and_the_same_again(tmp_path: Path) -> None:
    first = write(tmp_path)
    data = [path.read_bytes() for path in first]
    assert [path.name for path in first] == ["figure-7.png", "figure-7.svg"]
    assert data[0].startswith(b"\x89PNG")
    assert b"time until the first loss" in data[1]
    assert [path.read_bytes() for path in write(tmp_path)] == data
