"""The links to vehicles that fly elsewhere."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager

from comms.transport import Transport, TransportError, transport_of
from missions.mission import Mission
from missions.problems import InputError


@contextmanager
def open_transports(mission: Mission, uids: Iterable[int]) -> Iterator[dict[int, Transport]]:
    """The links of these agents to vehicles elsewhere, open, by uid.

    Raises:
        InputError: one cannot be opened.
    """
    links = {uid: link for uid in uids if (link := mission.link(uid)) is not None}
    with ExitStack() as stack:
        try:
            transports = {uid: stack.enter_context(transport_of(link)) for uid, link in links.items()}
        except TransportError as error:
            raise InputError(f"vehicle.links: {error}") from error
        yield transports
