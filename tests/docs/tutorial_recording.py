"""Flies and records what docs/reviewing.md reviews: `python -m tests.docs.tutorial_recording`.

What is only drawn is left out, so that the file is small; a review reads nothing of it.
"""

from __future__ import annotations

import shlex
from pathlib import Path
from tempfile import TemporaryDirectory

from rerun.chunk import LazyChunkStream, RrdReader

from missions.cli import main
from missions.recording import optimize
from missions.recording.reel import PATHS

RECORDING = Path(__file__).parents[2] / "docs" / "reviewing.rrd"
FLOWN = shlex.split(
    "launch quickstart --duration 60 --set name=lost-and-found --set tick_s=0.2 --set agents.count=5 "
    "--set targets.count=6 --set agents.deployment.radius_m=7 --set targets.deployment.radius_m=9 "
    "--set agents.altitude.base_m=5"
)
FAULT = "faults=[{kind: kill, agents: [1], at_s: 25, for_s: 10}]"
KNOWLEDGE, PROPERTIES = "/knowledge/**", "/__properties/**"
DRAWN = [
    f"{kind}:{part}"
    for kind in ("Points3D", "Arrows3D", "GraphNodes", "SeriesLines", "StateConfiguration", "TextLog")
    for part in (
        "colors",
        "color",
        "radii",
        "labels",
        "show_labels",
        "origins",
        "node_ids",
        "positions",
        "names",
        "widths",
    )
    if (kind, part) != ("Points3D", "positions")
]


def record() -> None:
    """Write the recording anew."""
    with TemporaryDirectory() as folder:
        whole, lean = Path(folder) / "whole.rrd", Path(folder) / "lean.rrd"
        assert main([*FLOWN, "--set", FAULT, "--record", str(whole)]) == 0
        reader = RrdReader(whole)
        numbers = reader.stream().filter(content=[path for path in PATHS if path != PROPERTIES])
        parts = (
            numbers.drop(components=DRAWN),
            reader.stream().filter(content=KNOWLEDGE, components="TextDocument:text"),
            reader.stream().filter(content=PROPERTIES),
        )
        entry = reader.recordings()[0]
        stream = LazyChunkStream.merge(*parts)
        stream.write_rrd(lean, application_id=entry.application_id, recording_id=entry.recording_id)
        optimize(lean, RECORDING)


if __name__ == "__main__":
    record()
