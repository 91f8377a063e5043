"""`swarm launch`: the shell around a flight. Clock, signals, files and terminal are here; the flight knows none."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from math import isinf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console

from comms.clock import Lockstep, Pace, RealTime
from comms.session import open_local_bus
from missions.flight import Flight
from missions.load import dump_mission
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observer
from missions.options import LaunchOptions
from missions.plan import coverage_floor
from missions.problems import InputError
from missions.progress import ProgressBar
from missions.report import PACKAGES, as_json, as_table, make_report, versions
from vehicle_sim.tracks import TracksError

if TYPE_CHECKING:
    from missions.recording import Recorder

DONE, FAILED, STOPPED = 0, 1, 130


class StopRequest:
    """Ctrl-C, once: come home. A second time: at once (KeyboardInterrupt)."""

    def __init__(self) -> None:
        self.asked = False

    @contextmanager
    def listening(self) -> Iterator[StopRequest]:
        """Listen while a flight is under way."""
        before = signal.signal(signal.SIGINT, self._hear)
        try:
            yield self
        finally:
            signal.signal(signal.SIGINT, before)

    def _hear(self, number: int, frame: Any) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True


def launch(mission: Mission, *, options: LaunchOptions) -> int:
    """Fly a mission to its report and recording. Returns the exit code.

    Raises:
        InputError: what only a launch can find out is wrong (unreadable tracks, no recorder installed).
    """
    console = Console(stderr=options.report == "-")
    metrics, request = Metrics(), StopRequest()
    with ExitStack() as stack:
        bus = stack.enter_context(open_local_bus())
        try:
            flight = Flight(mission, bus)
        except TracksError as error:
            raise InputError(str(error)) from error
        observers: list[Observer] = [metrics]
        if options.record is not None or options.view:
            observers.append(stack.enter_context(recorder_of(flight, options)))
        bar = ProgressBar(console, duration_s=mission.duration_s, tick_s=mission.tick_s)
        observers.append(stack.enter_context(bar))
        stack.enter_context(request.listening())
        began_s = time.monotonic()
        flight.run(pace=_pace(mission, options), observers=observers, stop=lambda: request.asked)
        wall_s = time.monotonic() - began_s
    report = make_report(flight, metrics, wall_s=wall_s, recording=options.record)
    console.print(as_table(report))
    if options.report == "-":
        sys.stdout.write(as_json(report))
    elif options.report is not None:
        Path(options.report).write_text(as_json(report), encoding="utf-8")
    if request.asked:
        return STOPPED
    return DONE if flight.complete else FAILED


def _pace(mission: Mission, options: LaunchOptions) -> Pace:
    return Lockstep() if isinf(options.speed) else RealTime(tick_s=mission.tick_s, speed=options.speed)


def recorder_of(flight: Flight, options: LaunchOptions) -> Recorder:
    """The recorder of a flight, not yet open.

    Raises:
        InputError: this installation cannot record.
    """
    try:
        from missions.recording import Recorder, Scene
    except ModuleNotFoundError as error:
        raise InputError(str(error)) from error
    mission = flight.mission
    scene = Scene(
        mission_name=mission.name,
        mission_yaml=dump_mission(mission),
        seed=mission.seed,
        policy=mission.policy.name,
        versions=versions((*PACKAGES, "rerun-sdk")),
        tick_s=mission.tick_s,
        arena=mission.arena.area,
        n_agents=mission.agents.count,
        n_targets=len(flight.world.places),
        sensing_range_m=mission.agents.sensing.range_m,
        home=mission.home.place,
        ceiling_m=max(mission.agents.altitude.of_agent(uid) for uid in range(mission.agents.count)),
        coverage_floor=coverage_floor(mission),
    )
    return Recorder(options.record, scene=scene, live=options.view, lossless=isinf(options.speed))
