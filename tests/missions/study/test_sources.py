"""What is compiled is kept under the name of its sources: an edit of any of them must not meet an old compilation."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from missions.study import sources

numba = pytest.importorskip("numba")  # imported first, as others may


def test_compilations_are_kept_under_the_name_of_their_sources() -> None:
    if os.environ.get("NUMBA_CACHE_DIR"):
        pytest.skip("the user has a folder of their own")
    import missions.study.compiled.loop  # noqa: F401

    assert Path(numba.config.CACHE_DIR).name == sources.sources_digest()


def test_every_rule_that_is_compiled_names_the_folder() -> None:
    from missions.study.compiled.rules import RULES

    named = {path for pattern in sources.SOURCES for path in sources.ROOT.glob(pattern)}
    assert named >= {Path(str(module.__file__)) for module in RULES}
    assert all(list(sources.ROOT.glob(pattern)) for pattern in sources.SOURCES)
