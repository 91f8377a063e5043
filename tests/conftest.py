"""Tests that fly compiled missions share one worker, so that the study is compiled once."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

COMPILED = {"study", "training"}


def pytest_collection_modifyitems(items: Sequence[pytest.Item]) -> None:
    for item in items:
        if item.path.parent.name in COMPILED:
            item.add_marker(pytest.mark.xdist_group("compiled"))
