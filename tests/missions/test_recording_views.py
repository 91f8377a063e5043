"""Every view of a recording in rerun's own viewer, which has nothing to complain of."""

from __future__ import annotations

from pathlib import Path

import pytest

from missions.cli import main
from tests.pictures.viewer import NoViewerError, viewer

TABS = (("Mission",), ("Knowledge", "A1"), ("Telemetry",), ("Map",), ("Raw",))


@pytest.mark.slow
@pytest.mark.parametrize("sight", ["omni", "sector", "camera"])
def test_the_viewer_reports_no_error_in_any_tab(tmp_path: Path, sight: str) -> None:
    path = tmp_path / "flown.rrd"
    changes = ("agents.count=3", f"agents.sensing.field_of_view={sight}", "radio.loss=0.3")
    given = [part for text in changes for part in ("--set", text)]
    assert main(["launch", "narrow", "--duration", "10", *given, "--record", str(path)]) == 0
    try:
        with viewer(path) as seen:
            for tabs in TABS:
                seen.turn_to(*tabs)
                seen.save(tmp_path / f"{tabs[0]}.png", at_s=30.0)
            assert list(seen.complaints) == []
    except NoViewerError as error:
        pytest.skip(str(error))
    sizes = [(tmp_path / f"{tabs[0]}.png").stat().st_size for tabs in TABS]
    assert min(sizes) > 10_000, "an empty picture"
