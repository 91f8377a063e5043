"""How the tests are run: laws on the same examples every time (or on new ones), compiled missions by one worker."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import HealthCheck, settings
from hypothesis.internal.conjecture import providers

# A busy computer is no failure: neither is an example late, nor drawing it.
PATIENT = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("steady", PATIENT, derandomize=True)
settings.register_profile("search", PATIENT, max_examples=2000, print_blob=True)  # `make search`
settings.load_profile("steady")

COMPILED = {"study", "training"}


def pytest_configure() -> None:
    if settings.get_current_profile_name() == "steady":
        # Examples take numbers from our modules, too: from those that this worker happens to have loaded by then.
        # There is no setting for it.
        providers._get_local_constants = providers.Constants


@pytest.hookimpl(tryfirst=True)  # before xdist looks for groups
def pytest_collection_modifyitems(items: Sequence[pytest.Item]) -> None:
    """Tests that fly compiled missions share one worker, so that the study is compiled once."""
    for item in items:
        if item.path.parent.name in COMPILED:
            item.add_marker(pytest.mark.xdist_group("compiled"))
