"""`swarm world`: targets, air and clock in a process of their own, through which all others of a mission speak."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial

from rich.console import Console

from comms.access import Gate, Place
from comms.keys import WORLD, Keys
from comms.radio import Roster
from comms.session import BusError, Network, open_router
from missions.daemons.crew import CrewError, Patience, RemoteCrew
from missions.daemons.desk import MissionDesk
from missions.daemons.feed import Feed
from missions.daemons.log import Log
from missions.daemons.options import DaemonOptions, await_back_s, fingerprint
from missions.ending import Ending
from missions.exit_codes import DONE, FAILED, STOPPED
from missions.faults.costs import Costs
from missions.launch import explain_every_s, pace_of
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observation, Observer
from missions.outcome import reported
from missions.outlet import outlet_console
from missions.problems import InputError
from missions.progress import Progress, progress_on
from missions.report import check_files
from missions.sides.world import WorldSide, fly

# A process that does not answer for so long does nothing any more, however busy the computer.
LOST_S = 10.0
LOST_IN_REAL_TIME_S = 3.0
# Of a tick, in real time: what is left is for the world itself.
TICK_SHARE = 0.8


@dataclass(frozen=True, slots=True, kw_only=True)
class WorldOptions:
    """Options of `swarm world` beside every daemon's.

    Attributes:
        report: where the report goes. recorded: wait for a recorder before it begins.
    """

    report: str | None = None
    recorded: bool = False


def world(mission: Mission, daemon: DaemonOptions, options: WorldOptions) -> int:
    """Run a mission's world until everybody has landed. Returns the exit code.

    Raises:
        InputError: it cannot listen there, or a file cannot be written.
    """
    check_files(report=options.report, record=None)
    console = outlet_console(stderr=options.report == "-")
    log = Log("world", least=daemon.log_level)
    ending = Ending(log.info)
    with ending.listening(leash=daemon.leash):
        try:
            with open_router(
                daemon.endpoint,
                lossless=daemon.lockstep,
                gate=_gate(mission, daemon),
                n_clients=mission.agents.count,
            ) as bus:
                return _run(mission, bus, daemon, options, ending=ending, log=log, console=console)
        except BusError as error:
            raise InputError(f"--listen: {error}") from error
        except CrewError as error:
            if ending.asked:
                log.info(str(error))
                return STOPPED if ending.interrupted else DONE
            log.error(str(error))
        except KeyboardInterrupt:
            log.error("ended at once, and the swarm flies home without a world")
    return STOPPED if ending.interrupted else FAILED


def _gate(mission: Mission, daemon: DaemonOptions) -> Gate | None:
    """Whom to let in: those whose certificates lie beside the world's own."""
    own = daemon.credentials
    if own is None:
        return None
    through_us = mission.radio.mode == "field" and not mission.radio.endpoints
    place = Place.FIELD if through_us else Place.AIR
    return Gate(own, Keys(mission.name), tuple(own.known), place)


def _run(
    mission: Mission,
    bus: Network,
    daemon: DaemonOptions,
    options: WorldOptions,
    *,
    ending: Ending,
    log: Log,
    console: Console,
) -> int:
    keys, metrics = Keys(mission.name), Metrics(costs=Costs(mission.faults, tick_s=mission.tick_s))
    side, desk = WorldSide(mission, bus), MissionDesk(bus, keys, ending)
    ours = fingerprint(mission, daemon.speed)
    crew = RemoteCrew(
        bus,
        keys=keys,
        roster=Roster(mission.agents.count, len(side.world.herd.places)),
        medium=side.medium,
        patience=_patience(mission, daemon),
        fingerprint=ours,
        tell=lambda uid, event: log.events([event], who=f"agent-{uid}"),
        stop=desk.is_closing,
    )
    feed = Feed(
        bus,
        keys=keys,
        lockstep=daemon.lockstep,
        fingerprint=ours,
        back_s=await_back_s(mission, daemon),
        begin=partial(_explain, side),
        tell=lambda event: log.events([event], who="recorder"),
    )
    disband = bus.declare_alive(keys.crew(mission.agents.count))
    bus.declare_alive(keys.alive(WORLD))
    known = "" if daemon.credentials is None else f" whose certificates lie in {daemon.credentials.folder}"
    log.info(f"listens on {daemon.endpoint}, and waits for {mission.agents.count} agents{known}")
    observers: list[Observer] = [metrics, feed, _Teller(log)]

    def part() -> None:
        disband()
        crew.dismiss()
        is_asked_again = ending.begin_anew()
        feed.close(stop=lambda: desk.is_closing() and is_asked_again())

    with ExitStack() as stack:
        stack.callback(part)
        if options.recorded:
            feed.await_recorder(daemon.join_s, stop=desk.is_closing)
        side.meet(crew.hello())
        with reported(side, metrics, to=options.report, console=console, recording=lambda: feed.recording):
            with _progress(mission, console, metrics) as progress:
                observers.append(progress)
                fly(side, crew, pace=pace_of(mission, daemon.speed), observers=observers, stop=desk.is_closing)
            was_asked = ending.asked
            # The report waits for the recording, of which it tells; that of a flight that is broken off does not.
            stack.close()
            for failure in feed.failures:
                metrics.fault(side.clock_s, None, failure)
    if ending.interrupted:
        return STOPPED
    if was_asked:
        return DONE
    return DONE if side.complete and len(crew.lost) <= mission.agents.may_lose and not feed.failures else FAILED


def _progress(mission: Mission, console: Console, metrics: Metrics) -> Progress:
    title = f"{mission.name}, seed {mission.seed}"
    return progress_on(console, title=title, duration_s=mission.duration_s, tick_s=mission.tick_s, metrics=metrics)


def _explain(side: WorldSide) -> None:
    """Somebody records: what agents know is wanted, too."""
    side.explain_every_s = explain_every_s(side.mission)


def _patience(mission: Mission, daemon: DaemonOptions) -> Patience:
    lockstep = daemon.lockstep
    return Patience(
        join_s=daemon.join_s,
        tick_s=LOST_S if lockstep else TICK_SHARE * mission.tick_s / daemon.speed,
        lost_s=LOST_S if lockstep else LOST_IN_REAL_TIME_S,
        back_s=await_back_s(mission, daemon),
        lockstep=lockstep,
    )


class _Teller:
    """An observer that logs what the mission itself has to say."""

    def __init__(self, log: Log) -> None:
        self._log = log

    def observe(self, observation: Observation) -> None:
        self._log.time_s = observation.time_s
        self._log.events(observation.events, who="mission")
