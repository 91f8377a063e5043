"""The tours in the packages' docstrings run, and say what they print."""

from __future__ import annotations

import doctest

import pytest

import comms
import comms.transport
import missions
import swarm_agent
import vehicle_sim


@pytest.mark.parametrize(
    "package", [comms, comms.transport, swarm_agent, vehicle_sim, missions], ids=lambda p: p.__name__
)
def test_the_tour_runs(package: object) -> None:
    result = doctest.testmod(package)  # type: ignore[arg-type]
    assert result.attempted > 0
    assert result.failed == 0
