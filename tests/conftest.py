"""Tests that fly compiled missions share one worker, so that the study is compiled once; no example has a deadline."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import settings

settings.register_profile("patient", deadline=None)  # a busy computer is no failure
settings.load_profile("patient")

COMPILED = {"study", "training"}


def pytest_collection_modifyitems(items: Sequence[pytest.Item]) -> None:
    for item in items:
        if item.path.parent.name in COMPILED:
            item.add_marker(pytest.mark.xdist_group("compiled"))
