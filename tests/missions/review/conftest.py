"""One small mission, flown and recorded once for all tests of reviews."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pytest

from missions.cli import main
from missions.report import Report
from missions.review.reading import Review, read

# Help is called for and targets are lost; radio frames are lost; five seconds on two cores.
FLOWN = ["launch", "quickstart", "--duration", "60", "--set", "radio.loss=0.1", "--set", "targets.count=12"]


@dataclass(frozen=True)
class Flown:
    """A recording, the mission's own report, and the review."""

    recording: Path
    report: Report
    review: Review


@pytest.fixture(scope="session")
def flown(tmp_path_factory: pytest.TempPathFactory) -> Flown:
    folder = tmp_path_factory.mktemp("flown")
    recording, report = folder / "flown.rrd", folder / "flown.json"
    assert main([*FLOWN, "--record", str(recording), "--report", str(report)]) == 0
    return Flown(recording, json.loads(report.read_text()), read(recording))
