"""The verbs of the command line that run a mission in many processes; each returns an exit code."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from math import isinf
from pathlib import Path
from time import time

from comms.credentials import OPERATOR, Credentials, agents_name, agents_named
from comms.keys import RECORDER, WORLD
from comms.status import Level
from missions.daemons.options import ENDPOINT, DaemonOptions
from missions.daemons.processes import ProcessOptions, ProcessPlan, plan_processes
from missions.daemons.radios import check_processes, own_endpoint
from missions.daemons.security import check_all_known, check_complete, check_listening, credentials_of, endpoint_of
from missions.load import load_mission
from missions.mission import Mission
from missions.mission.agents import MOST_AGENTS
from missions.options import Board, LaunchOptions, speed_of
from missions.outlet import outlet_console
from missions.problems import InputError
from missions.tlog import tlogs


def world(mission: Mission, options: argparse.Namespace) -> int:
    """Run a mission's world for agents in other processes."""
    from missions.daemons.world import WorldOptions
    from missions.daemons.world import world as run

    check_listening(options.endpoint, keys=options.keys, insecure=options.insecure)
    speed = _speed(mission, options.speed)
    daemon = _daemon(options, speed, WORLD)
    if daemon.credentials is not None:
        check_all_known(daemon.credentials, mission)
    settings = WorldOptions(report=options.report, recorded=options.recorded)
    return run(mission, daemon, settings)


def agent(mission: Mission, options: argparse.Namespace) -> int:
    """Run some of a mission's agents."""
    uids = uids_of(mission, options.id)
    if options.alone is not None:
        return _alone(mission, uids, options)
    from missions.daemons.agent import agent as run

    daemon = _daemon(options, _speed(mission, options.speed), agents_name(uids))
    check_radio(mission, uids, daemon.credentials, insecure=options.insecure)
    return run(mission, uids, daemon)


def _alone(mission: Mission, uids: Sequence[int], options: argparse.Namespace) -> int:
    """Run them without a world."""
    from missions.daemons.alone import alone as run

    if mission.radio.mode != "field":
        raise InputError(f"radio.mode: got {mission.radio.mode}; allowed with --alone: field")
    if mission.faults:
        raise InputError("faults: got some; allowed with --alone: none, as nobody injects them")
    if len(uids) < mission.agents.count and not mission.radio.endpoints:
        raise InputError(
            "radio.endpoints: got none; allowed with --alone: one for each agent, or nobody hears the other"
        )
    if options.speed not in (None, 1.0):
        got = "max" if isinf(options.speed) else f"{options.speed:g}"
        raise InputError(f"--speed: got {got}; allowed with --alone: 1, the clock's own")
    check_listening(options.alone, keys=options.keys, insecure=options.insecure, where="--alone")
    daemon = DaemonOptions(
        endpoint=endpoint_of(options.alone, keys=options.keys),
        speed=1.0,
        log_level=Level(options.log_level),
        leash=options.leash,
        credentials=credentials_of(options.keys, agents_name(uids)),
        tlog=options.tlog,
    )
    if daemon.credentials is not None:
        check_complete(daemon.credentials.of_radio)
    check_radio(mission, uids, daemon.credentials, insecure=options.insecure)
    return run(mission, uids, daemon)


def record(mission: Mission, options: argparse.Namespace) -> int:
    """Record a mission that other processes fly."""
    from missions.daemons.record import record as run

    speed = _speed(mission, options.speed)
    settings = LaunchOptions(speed=speed, record=options.record, view=options.view, web=options.web)
    if not settings.is_recorded:
        raise InputError("record: got nothing to do; allowed: --record, --view, --web, or several of them")
    return run(mission, _daemon(options, speed, RECORDER), settings)


def launch(mission: Mission, options: argparse.Namespace) -> int:
    """Start all processes of a mission, and stay until it is over."""
    if options.gcs or options.gcs_signing_key:
        raise InputError(
            "--gcs: not with --processes, where each vehicle is in another process; allowed: a launch without "
            "--processes, or without --gcs and --gcs-signing-key"
        )
    from missions.daemons.launcher import run_processes

    endpoint = options.listen or ENDPOINT
    plans = processes(mission, options, began_unix_s=time())

    def empty_logs() -> None:
        """Agents add to them, those that come back, too."""
        with tlogs(options.tlog, range(mission.agents.count), began_unix_s=None):
            pass

    report = None if options.report in (None, "-") else Path(options.report)
    console = outlet_console(stderr=True)
    return run_processes(plans, endpoint=endpoint, console=console, prepare=empty_logs, report=report)


def board(options: argparse.Namespace, *, speed: float) -> Board | None:
    """Where people speak to a mission in one process: where they were told, and while it goes by the clock, anyway.

    Raises:
        InputError: nobody may listen there, or prove who they are by what lies in the folder of keys.
    """
    if options.listen is None and isinf(speed):
        return None
    endpoint = options.listen or ENDPOINT
    check_listening(endpoint, keys=options.keys, insecure=options.insecure)
    return Board(
        endpoint=endpoint_of(endpoint, keys=options.keys),
        is_required=options.listen is not None,
        credentials=credentials_of(options.keys, WORLD),
    )


def fleet(verb: str, options: argparse.Namespace) -> int:
    """Tell vehicles that are under way, or ask them."""
    mission = None if options.mission is None else load_mission(options.mission)
    uids = None
    if options.id is not None:
        uids = whole_range(options.id) if mission is None else uids_of(mission, options.id)
    from missions.daemons.fleet import FleetOptions, tell
    from missions.daemons.orders import Verb

    name = None if mission is None else mission.name
    settings = FleetOptions(
        endpoint=endpoint_of(options.connect, keys=options.keys),
        mission=name,
        uids=uids,
        credentials=credentials_of(options.keys, OPERATOR),
    )
    return tell(Verb(verb), settings)


def issue(options: argparse.Namespace) -> int:
    """Make the credentials of a swarm."""
    from missions.daemons.issue import issue as make

    names = make(options.folder, n_agents=options.agents, per_process=options.per_process, force=options.force)
    sys.stdout.write(f"{options.folder}: {', '.join(names)}\n")
    return 0


def processes(
    mission: Mission, options: argparse.Namespace, *, began_unix_s: float | None = None
) -> tuple[ProcessPlan, ...]:
    """What a launch with these options would start, at that time if it does."""
    given = vars(options)
    speed = given.get("speed")
    _speed(mission, speed)
    endpoint = options.listen or ENDPOINT
    check_listening(endpoint, keys=options.keys, insecure=options.insecure)
    endpoint_of(endpoint, keys=options.keys)
    settings = ProcessOptions(
        mission_words=tuple(_mission_words(options)),
        endpoint=endpoint,
        speed=None if speed is None else "max" if isinf(speed) else f"{speed}",
        report=given.get("report"),
        record=given.get("record"),
        tlog=given.get("tlog"),
        began_unix_s=began_unix_s,
        views=tuple(f"--{name}" for name in ("view", "web") if given.get(name)),
        per_process=options.processes,
        restarts=options.restarts,
        log_level=options.log_level,
        keys=options.keys,
        insecure=options.insecure,
    )
    check_processes(mission, options.processes)
    plans = plan_processes(mission, settings)
    for plan in plans:
        credentials = credentials_of(options.keys, plan.identity)
        uids = agents_named(plan.identity)
        if uids:
            check_radio(mission, uids, credentials, insecure=options.insecure)
    return plans


def check_radio(mission: Mission, uids: Sequence[int], credentials: Credentials | None, *, insecure: bool) -> None:
    """See that the radio of these agents, if they have one of their own, is theirs, and that nobody comes in unasked.

    Raises:
        InputError: it is not, or somebody may.
    """
    if not mission.radio.endpoints:
        return
    endpoint = own_endpoint(mission, uids)
    keys = None if credentials is None else credentials.folder
    check_listening(endpoint, keys=keys, insecure=insecure, where="radio.endpoints")
    if credentials is not None:
        check_complete(credentials.of_radio)


def _speed(mission: Mission, asked: float | None) -> float:
    """As `speed_of`, for many processes: nobody waits for what goes from radio to radio.

    Raises:
        InputError: such a speed is not for the mission.
    """
    if not mission.radio.endpoints:
        return speed_of(mission, asked)
    if asked is not None and isinf(asked):
        raise InputError("--speed: got max; allowed: a number: agents hear each other by radio.endpoints, in real time")
    return speed_of(mission, asked or 1.0)


def _mission_words(options: argparse.Namespace) -> Iterator[str]:
    """The mission, and what changes it, as other processes are told."""
    yield options.mission
    for option, text in (("--seed", options.seed), ("--duration", options.duration)):
        if text is not None:
            yield from (option, text)
    for text in options.set:
        yield from ("--set", text)


def uids_of(mission: Mission, text: str) -> tuple[int, ...]:
    """The agents that `--id` names: `3`, or `0-4`.

    Raises:
        InputError: the mission has no such agents.
    """
    return whole_range(text, most=mission.agents.count - 1)


def whole_range(text: str, *, most: int = MOST_AGENTS - 1) -> tuple[int, ...]:
    """The numbers that `3`, or `0-4`, names.

    Raises:
        InputError: it names none up to `most`.
    """
    first, dash, last = text.partition("-")
    numbers = [first, last if dash else first]
    if all(number.isascii() and number.isdigit() and len(number) < 6 for number in numbers):
        low, high = map(int, numbers)
        if low <= high <= most:
            return tuple(range(low, high + 1))
    raise InputError(f'--id: got "{text}"; allowed: a number from 0 to {most}, or several, such as 0-{most}')


def _daemon(options: argparse.Namespace, speed: float, name: str) -> DaemonOptions:
    return DaemonOptions(
        endpoint=endpoint_of(options.endpoint, keys=options.keys),
        join_s=options.join_timeout,
        speed=speed,
        log_level=Level(options.log_level),
        leash=options.leash,
        credentials=credentials_of(options.keys, name),
        tlog=vars(options).get("tlog"),
        tlog_began_unix_s=vars(options).get("tlog_began"),
    )
