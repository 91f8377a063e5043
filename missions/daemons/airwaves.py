"""Where the frames of a process's agents go: through the world, or from radio to radio where a mission says so."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager

from comms.access import Gate, Place
from comms.credentials import agents_name
from comms.keys import Keys
from comms.session import Bus, BusError, open_peer
from missions.daemons.options import DaemonOptions
from missions.daemons.radios import own_endpoint, radios_of
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


def _before(endpoints: Iterable[str], own: str) -> Iterator[str]:
    for endpoint in endpoints:
        if endpoint == own:
            return
        yield endpoint
