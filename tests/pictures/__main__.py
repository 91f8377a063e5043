"""`make pictures`: flies what is to be seen, and renders it into docs/.

    python -m tests.pictures [NAME...] [--out DIR]

Fails when the viewer has an error to report of anything it shows.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from missions.cli import main as swarm
from tests.benchmarks.recording import SIZES
from tests.docs.tutorial_recording import RECORDING
from tests.pictures import pages, terminal
from tests.pictures.viewer import viewer

DOCS = Path(__file__).parents[2] / "docs"


def _set(*texts: str) -> tuple[str, ...]:
    return tuple(part for text in texts for part in ("--set", text))


@dataclass(frozen=True, slots=True)
class Shot:
    """What is flown, and which moment of it the viewer shows in which tab, dark or light."""

    launch: tuple[str, ...]
    at_s: float
    tabs: tuple[str, ...]
    light: bool = False
    size: tuple[int, int] = (1280, 720)


SHOTS = {
    "early": Shot(("quickstart",), 23.0, ("Mission",)),
    "quickstart": Shot(("quickstart",), 52.0, ("Mission",)),
    "light": Shot(("quickstart",), 52.0, ("Mission",), light=True),
    "knowledge": Shot(("quickstart",), 60.0, ("Knowledge", "A4")),
    "telemetry": Shot(("quickstart",), 60.0, ("Telemetry",)),
    "faults": Shot(("faults",), 72.0, ("Mission",)),
    "map": Shot(("wildlife", "--duration", "120"), 100.0, ("Map",)),
    "three": Shot(("narrow", "--duration", "60", *_set("agents.count=3", "targets.count=3")), 25.0, ("Mission",)),
    "hundred": Shot(("quickstart", *_set(*SIZES["100 + 100"], "duration_s=90")), 100.0, ("Mission",)),
}


def _plot(path: Path) -> None:
    assert swarm(["review", str(RECORDING), "--plot", str(path)]) == 0


# What is not shown by the viewer, by file name.
DRAWN: Mapping[str, Callable[[Path], None]] = {
    "reviewing.png": _plot,
    "report.png": pages.report,
    "report-dark.png": pages.report_dark,
    "report-phone.png": pages.report_phone,
    "web.png": pages.web,
    "panel.svg": terminal.panel,
    "status.svg": terminal.status,
    "review.svg": terminal.review,
}


def main() -> int:
    """Render the pictures asked for, or all."""
    names = (*SHOTS, *(name.partition(".")[0] for name in DRAWN))
    parser = argparse.ArgumentParser(description="Render the pictures in docs/.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"some of {', '.join(names)}; all unless given")
    parser.add_argument("--out", type=Path, default=DOCS)
    options = parser.parse_args()
    if unknown := sorted({*options.names} - {*names}):
        parser.error(f"got {', '.join(unknown)}; allowed: {', '.join(names)}")
    wanted = frozenset(options.names or names)
    for name, draw in DRAWN.items():
        if name.partition(".")[0] in wanted:
            draw(options.out / name)
    complaints = dict.fromkeys(_shoot({name: shot for name, shot in SHOTS.items() if name in wanted}, options.out))
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


def _shoot(shots: Mapping[str, Shot], out: Path) -> Iterator[str]:
    """Fly each mission once, take its pictures, and tell what the viewer complains of."""
    with TemporaryDirectory() as folder:
        for flown in dict.fromkeys(shot.launch for shot in shots.values()):
            recording = Path(folder) / "flown.rrd"
            if swarm(["launch", *flown, "--record", str(recording)]) != 0:
                yield f"swarm launch {' '.join(flown)} failed"
                continue
            for name, shot in shots.items():
                if shot.launch == flown:
                    with viewer(recording, size=shot.size, light=shot.light) as seen:
                        seen.turn_to(*shot.tabs)
                        seen.save(out / f"{name}.png", at_s=shot.at_s)
                        yield from seen.complaints


if __name__ == "__main__":
    sys.exit(main())
