"""Where the frames of a process's agents go: through the world, or from radio to radio where a mission says so."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from itertools import groupby

from comms.access import Gate, Place
from comms.credentials import agents_name
from comms.keys import Keys
from comms.session import Bus, BusError, open_peer
from missions.daemons.options import DaemonOptions
from missions.daemons.security import endpoint_of
from missions.mission import Mission
from missions.problems import InputError


@contextmanager
def open_airwaves(mission: Mission, uids: Sequence[int], options: DaemonOptions, world: Bus) -> Iterator[Bus]:
    """The bus on which these agents speak to their mates: `world`, or their own radio's.

    Raises:
        InputError: the radio's endpoint is not of this computer, or not free; or other agents share it.
    """
    sharing = radios_of(mission)
    if not sharing:
        yield world
        return
    names = {endpoint: agents_name(group) for endpoint, group in sharing.items()}
    own = own_endpoint(mission, uids)
    gate = None
    if options.credentials is not None:
        gate = Gate(options.credentials.of_radio, Keys(mission.name), tuple(names.values()), Place.RADIO)
    keys = None if options.credentials is None else options.credentials.folder
    # Of two radios one calls the other, or they would be joined twice: the later one of the mission's list.
    earlier = [endpoint_of(endpoint, keys=keys) for endpoint in _before(names, own)]
    with ExitStack() as stack:
        try:
            bus = stack.enter_context(open_peer(endpoint_of(own, keys=keys), earlier, gate=gate))
        except BusError as error:
            raise InputError(f"radio.endpoints: {error}") from error
        yield bus


def radios_of(mission: Mission) -> dict[str, list[int]]:
    """Which agents share each of the radios that a mission names, in its order."""
    by_endpoint = groupby(range(len(mission.radio.endpoints)), key=mission.radio.endpoints.__getitem__)
    return {endpoint: list(group) for endpoint, group in by_endpoint}


def own_endpoint(mission: Mission, uids: Sequence[int]) -> str:
    """Where the radio of the process that runs these agents listens.

    Raises:
        InputError: other agents than these share it.
    """
    endpoint = mission.radio.endpoints[uids[0]]
    group = radios_of(mission)[endpoint]
    if list(uids) != group:
        words = f"{group[0]}-{group[-1]}" if len(group) > 1 else f"{group[0]}"
        got = f"{uids[0]}-{uids[-1]}" if len(uids) > 1 else f"{uids[0]}"
        raise InputError(f"--id: got {got}; allowed: {words}, which shares {endpoint} of radio.endpoints")
    return endpoint


def _before(endpoints: Iterable[str], own: str) -> Iterator[str]:
    for endpoint in endpoints:
        if endpoint == own:
            return
        yield endpoint
