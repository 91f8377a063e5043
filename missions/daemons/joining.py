"""How agents and the recorder come to the world, and what they say if it is not there, or keeps them out."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from contextlib import contextmanager

from comms.keys import FLIGHT, Keys
from comms.session import BusError, Network, open_client
from missions.daemons.log import Log
from missions.daemons.options import DaemonOptions
from missions.daemons.security import why
from missions.ending import Ending
from missions.exit_codes import DONE, FAILED, STOPPED
from missions.mission import Mission


@contextmanager
def open_world(options: DaemonOptions, *, ending: Ending, log: Log, n_peers: int = 0) -> Iterator[Network]:
    """The bus that goes through the world; it is tried until the process is to end.

    Args:
        n_peers: how many radios this process will speak to besides.

    Raises:
        BusError: the world is not there in time, or does not let us in; see `unmet`.
    """
    with open_client(
        options.endpoint,
        lossless=options.lockstep,
        patience_s=options.join_s,
        credentials=options.credentials,
        tell=lambda error: log.error(f"{why(error, options.credentials, otherwise='')}; still trying"),
        stop=lambda: ending.asked,
        n_peers=n_peers,
    ) as bus:
        yield bus


def new_life() -> int:
    """What tells this process from all others that are, were or will be in its place. No decision depends on it."""
    return 1 + secrets.randbits(52)


def tell_of_flight(bus: Network, keys: Keys, log: Log) -> None:
    """Say so if it is no world that has the endpoint, but a launch of the same mission that flies all agents itself."""

    def on_change(key: str, is_there: bool) -> None:
        if is_there:
            log.error(f"{keys.mission} flies there in one process, which lets nobody in")

    bus.watch(keys.alive(FLIGHT), on_change)


def unmet(error: BusError, mission: Mission, options: DaemonOptions, *, ending: Ending, log: Log) -> int:
    """Say why there is no world, unless nobody wants one any more. Returns the exit code."""
    if ending.asked:
        return STOPPED if ending.interrupted else DONE
    log.error(why(error, options.credentials, otherwise=f"does `swarm world {mission.name}` run there?"))
    return FAILED
