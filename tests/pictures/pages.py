"""What is seen in a browser: the page of a review, and the web viewer beside a running mission."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from comms.clock import Lockstep
from comms.session import open_local_bus
from missions.cli import main as swarm
from missions.flight import Flight
from missions.launch import explain_every_s, recorder_of
from missions.load import load_mission
from missions.observation import Observation
from missions.options import LaunchOptions
from tests.docs.tutorial_recording import RECORDING
from tests.pictures.browser import browser

_PAGE, _PHONE, _SCREEN = (1180, 1560), (390, 844), (1280, 720)
_WATCHED_S = 52.0


def report(path: Path) -> None:
    """The page, for a reader who likes it light."""
    _report(path, size=_PAGE, dark=False)


def report_dark(path: Path) -> None:
    """The same page, for a reader who likes it dark."""
    _report(path, size=_PAGE, dark=True)


def report_phone(path: Path) -> None:
    """The same page, on a phone."""
    _report(path, size=_PHONE, dark=False)


def _report(path: Path, *, size: tuple[int, int], dark: bool) -> None:
    with TemporaryDirectory() as folder, browser() as page:
        file = Path(folder) / "report.html"
        assert swarm(["review", str(RECORDING), "--report", str(file)]) == 0
        page.open(file.as_uri(), size=size, dark=dark)
        page.save(path)


def web(path: Path) -> None:
    """What `--web` serves while the mission is under way."""
    mission = load_mission("quickstart")
    options = LaunchOptions(web=True)
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.side.explain_every_s = explain_every_s(mission)
        with recorder_of(mission, len(flight.world.places), options) as recorder, browser() as page:

            class Onlooker:
                """Comes late, looks once, and the mission waits."""

                def observe(self, observation: Observation) -> None:
                    if abs(observation.time_s - _WATCHED_S) < 1e-6:
                        page.open(f"{recorder.page_url}&renderer=webgl", size=_SCREEN, dark=True)
                        page.save(path)

            flight.run(pace=Lockstep(), observers=[recorder, Onlooker()], stop=lambda: flight.clock_s > _WATCHED_S)
