"""`make pictures`: flies what is to be seen, and renders it into docs/.

    python -m tests.pictures [NAME...] [--out DIR]

Fails when the viewer has an error to report of anything it shows.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from missions.cli import main as swarm
from tests.benchmarks.recording import SIZES
from tests.pictures import paper
from tests.pictures.viewer import viewer

DOCS = Path(__file__).parents[2] / "docs"


def _set(*texts: str) -> tuple[str, ...]:
    return tuple(part for text in texts for part in ("--set", text))


@dataclass(frozen=True, slots=True)
class Picture:
    """What is flown, and which moment of it is shown in which tab."""

    launch: tuple[str, ...]
    at_s: float
    tabs: tuple[str, ...]
    size: tuple[int, int] = (1280, 720)


PICTURES = {
    "quickstart": Picture(("quickstart",), 52.0, ("Mission",)),
    "knowledge": Picture(("quickstart",), 60.0, ("Knowledge", "A4")),
    "faults": Picture(("faults",), 128.0, ("Mission",)),
    "map": Picture(("wildlife", "--duration", "120"), 100.0, ("Map",)),
    "hundred": Picture(("quickstart", *_set(*SIZES["100 + 100"], "duration_s=90")), 100.0, ("Mission",)),
}


def main() -> int:
    """Render the pictures asked for, or all."""
    names = (*PICTURES, *paper.NAMES)
    parser = argparse.ArgumentParser(description="Render the pictures in docs/.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"some of {', '.join(names)}; all unless given")
    parser.add_argument("--out", type=Path, default=DOCS)
    options = parser.parse_args()
    wanted = options.names or names
    chosen = {name: PICTURES[name] for name in wanted if name in PICTURES}
    for name in wanted:
        if name in paper.NAMES:
            paper.draw(name, options.out)
    complaints: dict[str, None] = {}
    with TemporaryDirectory() as folder:
        for flown in dict.fromkeys(picture.launch for picture in chosen.values()):
            recording = Path(folder) / "flown.rrd"
            if swarm(["launch", *flown, "--record", str(recording)]) != 0:
                return 1
            for name, picture in chosen.items():
                if picture.launch == flown:
                    with viewer(recording, size=picture.size) as seen:
                        seen.turn_to(*picture.tabs)
                        seen.save(options.out / f"{name}.png", at_s=picture.at_s)
                        complaints |= seen.complaints
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
