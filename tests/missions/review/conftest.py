"""One small mission, flown and recorded once for all tests of reviews."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pytest

from missions.cli import main
from missions.report import Report
from missions.review.reading import Review, read

# Help is called for and targets are lost, radio frames are lost, a computer fails; five seconds on two cores.
FLOWN = ["launch", "quickstart", "--duration", "50", "--set", "radio.loss=0.1", "--set", "targets.count=12"]
FLOWN += ["--set", "faults=[{kind: kill, agents: [1], at_s: 20, for_s: 10}]"]


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
