"""`swarm launch`: the shell around a flight. Clock, signals, files and terminal are here; the flight knows none."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from contextlib import ExitStack
from datetime import UTC, datetime
from math import acos, isinf
from typing import TYPE_CHECKING

from rich.console import Console

from comms.clock import Lockstep, Pace, RealTime
from comms.keys import Keys
from comms.session import Network, open_local_bus
from missions.checkout import commit
from missions.compose import cos_half_opening
from missions.daemons.attended import Attended
from missions.daemons.desk import CrewDesk, MissionDesk, open_board
from missions.ending import Ending
from missions.exit_codes import DONE, FAILED, STOPPED
from missions.faults.costs import Costs
from missions.faults.schedule import spells_of
from missions.flight import Flight
from missions.ground_link import open_ground_link
from missions.links import open_transports
from missions.load import dump_mission
from missions.log import EventLog
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observer
from missions.options import LaunchOptions
from missions.outcome import reported
from missions.outlet import outlet_console
from missions.plan import coverage_floor
from missions.problems import InputError, OutputError
from missions.progress import progress_on
from missions.report import PACKAGES, check_files, versions
from missions.tlog import Tlog, failures, tlogs
from vehicle_sim.autopilot import SimulatedVehicle

if TYPE_CHECKING:
    from pathlib import Path

    from missions.recording import Recorder

# How often an agent tells a recorder what it knows; in a large swarm it takes longer until all have told.
EXPLAIN_EVERY_S, EXPLAINED_A_S = 1.0, 25


def launch(mission: Mission, *, options: LaunchOptions) -> int:
    """Fly a mission to its report and recording. Returns the exit code.

    Raises:
        InputError: what only a launch can find out is wrong (no recorder installed, a file that cannot be written).
    """
    console = outlet_console(stderr=options.report == "-")
    check_files(report=options.report, record=options.record)
    metrics = Metrics(costs=Costs(mission.faults, tick_s=mission.tick_s))
    ending = Ending(lambda text: console.print(f"Stopping: {text}.", markup=False))
    with (
        open_board(options.board, Keys(mission.name), tell=_teller(console)) as board,
        open_local_bus() as bus,
        open_transports(mission, range(mission.agents.count)) as transports,
        ending.listening(),
    ):
        flight = Flight(mission, bus, transports)
        try:
            with reported(
                flight.side, metrics, to=options.report, console=console, recording=lambda: _kept_in(options.record)
            ):
                kept = _fly(flight, board, metrics, ending, console, options)
        except KeyboardInterrupt:
            return STOPPED if ending.interrupted else FAILED
    if ending.asked:
        return STOPPED if ending.interrupted else DONE
    return DONE if flight.complete and kept else FAILED


def _teller(console: Console) -> Callable[[str], None]:
    return lambda text: console.print(text, soft_wrap=True, markup=False, highlight=False)


def _fly(
    flight: Flight, board: Network | None, metrics: Metrics, ending: Ending, console: Console, options: LaunchOptions
) -> bool:
    """Fly, with everybody watching who should, and people heard on the board. Returns whether all was kept."""
    mission = flight.mission
    kept = True
    with ExitStack() as stack:
        links = [
            stack.enter_context(open_ground_link(url, _simulated(flight), option="--gcs", key=options.gcs_key))
            for url in options.gcs
        ]
        uids = [side.uid for side in flight.crew]
        logs = stack.enter_context(tlogs(options.tlog, uids, began_unix_s=time.time()))
        for side in flight.crew if logs else ():
            side.tap = logs[side.uid].pass_on
        observers: list[Observer] = [*links, metrics]
        if mission.in_real_time:
            observers.append(EventLog(console))
        recorder = recorder_of(mission, len(flight.world.places), options) if options.is_recorded else None
        if recorder is not None:
            try:
                recorder.__enter__()
            except OutputError as error:
                raise InputError(str(error)) from error
            if recorder.page_url is not None:
                console.print(f"Watch it in a browser: {recorder.page_url}", soft_wrap=True, markup=False)
            observers.append(recorder)
            flight.side.explain_every_s = explain_every_s(mission)
        progress = progress_on(
            console,
            title=f"{mission.name}, seed {mission.seed}",
            duration_s=mission.duration_s,
            tick_s=mission.tick_s,
            metrics=metrics,
        )
        observers.append(stack.enter_context(progress))
        attended, stop = None, lambda: ending.asked
        if board is not None:
            keys = Keys(mission.name)
            attended = [Attended(side, tick_s=mission.tick_s) for side in flight.crew]
            observers.append(CrewDesk(board, keys, attended))
            stop = MissionDesk(board, keys, ending).is_closing
        try:
            flight.run(pace=pace_of(mission, options.speed), observers=observers, stop=stop, attended=attended)
        finally:
            kept = recorder is None or _closed(recorder, metrics, flight)
            kept = _logged(logs.values(), metrics, flight) and kept
        for link in links:
            console.print(str(link), soft_wrap=True, markup=False)
    return kept


def _simulated(flight: Flight) -> list[SimulatedVehicle]:
    """The vehicles that are ours to show; a ground station has its own link to those elsewhere."""
    return [vehicle for vehicle in flight.vehicles if isinstance(vehicle, SimulatedVehicle)]


def _closed(recorder: Recorder, metrics: Metrics, flight: Flight) -> bool:
    """Close the recording; what went wrong with it is a fault of the mission's, not its end."""
    try:
        recorder.__exit__(None, None, None)
    except OutputError as error:
        metrics.fault(flight.clock_s, None, str(error))
        return False
    if recorder.dropped:
        metrics.fault(flight.clock_s, None, f"the recorder was too slow: {recorder.dropped} ticks are missing")
    return not recorder.dropped


def _kept_in(record: Path | None) -> Path | None:
    """The recording's first file: an unfinished one, if something went wrong."""
    if record is None:
        return None
    from missions.recording.names import begins_in

    return begins_in(record)


def _logged(logs: Collection[Tlog], metrics: Metrics, flight: Flight) -> bool:
    """Close the logs; what could not be kept is a fault of the mission's, not its end."""
    for log in logs:
        log.close()
    broken = failures(logs)
    for failure in broken:
        metrics.fault(flight.clock_s, None, failure)
    return not broken


def pace_of(mission: Mission, speed: float) -> Pace:
    """How the mission's clock goes: `inf` is as fast as it can."""
    return Lockstep() if isinf(speed) else RealTime(tick_s=mission.tick_s, speed=speed)


def explain_every_s(mission: Mission) -> float:
    """How often agents tell what they know, when somebody records."""
    return max(EXPLAIN_EVERY_S, mission.agents.count / EXPLAINED_A_S)


def recorder_of(mission: Mission, n_targets: int, options: LaunchOptions) -> Recorder:
    """The recorder of a mission, not yet open.

    Raises:
        InputError: this installation cannot record.
    """
    try:
        from missions.recording import Recorder, Scene
    except ModuleNotFoundError as error:
        raise InputError(str(error)) from error
    source = commit()
    scene = Scene(
        mission_name=mission.name,
        mission_yaml=dump_mission(mission),
        seed=mission.seed,
        policy=mission.policy.name,
        versions=versions((*PACKAGES, "rerun-sdk")) | ({"git": source} if source else {}),
        tick_s=mission.tick_s,
        arena=mission.arena.area,
        n_agents=mission.agents.count,
        n_targets=n_targets,
        sensing_ranges_m=mission.agents.sensing_ranges_m,
        half_opening_rad=acos(max(-1.0, cos_half_opening(mission))),
        home=mission.home.place,
        ceiling_m=max(mission.agents.altitude.of_agent(uid) for uid in range(mission.agents.count)),
        coverage_floor=coverage_floor(mission),
        flown_at="" if isinf(options.speed) else datetime.now(UTC).isoformat(timespec="seconds"),
        faults=spells_of(mission.faults, mission.tick_s),
    )
    record = None if options.record is None else options.record.resolve()
    return Recorder(record, scene=scene, view=options.view, web=options.web, lossless=isinf(options.speed))
