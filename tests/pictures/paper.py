"""What is not shown by the viewer: the plot and the page of a review, and the panel of a launch."""

from __future__ import annotations

import subprocess
from io import StringIO
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory

from rich.console import Console

from comms.clock import Lockstep
from comms.session import open_local_bus
from missions.cli import main as swarm
from missions.flight import Flight
from missions.load import load_mission
from missions.metrics import Metrics
from missions.observation import Observation
from missions.panel import panel_of
from missions.progress import Pulse
from tests.docs.tutorial_recording import RECORDING

NAMES = ("reviewing", "report", "panel")
_BROWSERS = ("chromium", "chromium-browser", "google-chrome")
_PAGE_SIZE = "1180,1560"
_PANEL_AT_S = 62.0


def draw(name: str, out: Path) -> None:
    """Draw one of NAMES into the folder `out`."""
    {"reviewing": _plot, "report": _page, "panel": _panel}[name](out)


def _plot(out: Path) -> None:
    assert swarm(["review", str(RECORDING), "--plot", str(out / "reviewing.png")]) == 0


def _page(out: Path) -> None:
    browser = next(filter(None, map(which, _BROWSERS)), None)
    assert browser is not None, f"a picture of a page needs one of {', '.join(_BROWSERS)}"
    with TemporaryDirectory() as folder:
        page = Path(folder) / "report.html"
        assert swarm(["review", str(RECORDING), "--report", str(page)]) == 0
        shot = [f"--screenshot={out / 'report.png'}", f"--window-size={_PAGE_SIZE}", "--hide-scrollbars"]
        quiet = ["--headless=new", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}"]
        subprocess.run([browser, *quiet, *shot, page.as_uri()], check=True, capture_output=True, timeout=120)


class _Glance:
    """Looks at the panel at one moment."""

    def __init__(self, metrics: Metrics, pulse: Pulse, console: Console) -> None:
        self._metrics, self._pulse, self._console = metrics, pulse, console

    def observe(self, observation: Observation) -> None:
        self._metrics.observe(observation)
        self._pulse.observe(observation)
        if abs(observation.time_s - _PANEL_AT_S) < 1e-6:
            self._console.print(panel_of(self._pulse.vitals(observation)))


def _panel(out: Path) -> None:
    mission, metrics = load_mission("quickstart"), Metrics()
    console = Console(file=StringIO(), width=86, record=True, force_terminal=True)
    title = f"{mission.name}, seed {mission.seed}"
    pulse = Pulse(title=title, duration_s=mission.duration_s, tick_s=mission.tick_s, metrics=metrics)
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        glance = _Glance(metrics, pulse, console)
        flight.run(pace=Lockstep(), observers=[glance], stop=lambda: flight.clock_s > _PANEL_AT_S)
    console.save_svg(str(out / "panel.svg"), title="swarm launch quickstart", unique_id="panel")
