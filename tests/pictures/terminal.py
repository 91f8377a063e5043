"""What is seen in a terminal, as SVG: the panel of a launch, the status of processes, a review."""

from __future__ import annotations

import subprocess
import sys
import time
from io import StringIO
from pathlib import Path

from rich.console import Console

from comms.clock import Lockstep
from comms.session import open_client, open_local_bus
from missions.daemons.fleet import CONNECT_S, FleetOptions, ask, status_table
from missions.daemons.options import ENDPOINT
from missions.daemons.orders import Verb
from missions.flight import Flight
from missions.load import load_mission
from missions.metrics import Metrics
from missions.observation import Observation
from missions.panel import panel_of
from missions.progress import Pulse
from missions.review.reading import read
from missions.review.summary import print_summary
from tests.docs.tutorial_recording import RECORDING

_COLUMNS = 90
_PANEL_AT_S = 62.0
# Wall time from the start of the processes until all agents are at work: the mission begins after 20 s.
_STATUS_AFTER_S = 45.0


def panel(path: Path) -> None:
    """The panel of `swarm launch`, a minute into a mission."""
    mission, metrics, console = load_mission("quickstart"), Metrics(), _console()
    title = f"{mission.name}, seed {mission.seed}"
    pulse = Pulse(title=title, duration_s=mission.duration_s, tick_s=mission.tick_s, metrics=metrics)
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        glance = _Glance(metrics, pulse, console)
        flight.run(pace=Lockstep(), observers=[glance], stop=lambda: flight.clock_s > _PANEL_AT_S)
    console.save_svg(str(path), title="swarm launch quickstart", unique_id="panel")


def status(path: Path) -> None:
    """The table of `swarm status`, of a mission in processes."""
    command = [sys.executable, "-m", "missions.cli", "launch", "quickstart", "--processes", "--speed", "1"]
    quiet = subprocess.DEVNULL
    with subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=quiet) as launch:
        try:
            time.sleep(_STATUS_AFTER_S)
            with open_client(ENDPOINT, lossless=True, patience_s=CONNECT_S) as bus:
                answers = ask(bus, Verb.STATUS, FleetOptions())
        finally:
            launch.terminate()
    console = _console()
    console.print(status_table(answers))
    console.save_svg(str(path), title="swarm status", unique_id="status")


def review(path: Path) -> None:
    """The summary of `swarm review`."""
    console = _console()
    print_summary(read(RECORDING), console)
    console.save_svg(str(path), title=f"swarm review docs/{RECORDING.name}", unique_id="review")


def _console() -> Console:
    return Console(
        file=StringIO(), width=_COLUMNS, record=True, force_terminal=True, color_system="truecolor", highlight=False
    )


class _Glance:
    """Looks at the panel at one moment."""

    def __init__(self, metrics: Metrics, pulse: Pulse, console: Console) -> None:
        self._metrics, self._pulse, self._console = metrics, pulse, console

    def observe(self, observation: Observation) -> None:
        self._metrics.observe(observation)
        self._pulse.observe(observation)
        if abs(observation.time_s - _PANEL_AT_S) < 1e-6:
            self._console.print(panel_of(self._pulse.vitals(observation)))
