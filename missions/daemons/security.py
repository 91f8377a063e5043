"""Whether those who speak to each other prove who they are: `--keys`, `--insecure`, and where to look when it fails."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from comms.credentials import Credentials, agents_named
from comms.endpoint import is_local
from missions.mission import Mission
from missions.problems import InputError

if TYPE_CHECKING:
    from comms.session import BusError

_SECURED = "tls/"


def endpoint_of(text: str, *, keys: Path | None) -> str:
    """The endpoint as it is spoken to: with keys, TLS in place of bare TCP.

    Raises:
        InputError: TLS without keys.
    """
    if keys is None:
        if text.startswith(_SECURED):
            raise InputError(f"{text}: got no keys; allowed: --keys DIR, with what `swarm keys DIR` makes")
        return text
    return _SECURED + text.partition("/")[2]


def check_listening(text: str, *, keys: Path | None, insecure: bool, where: str = "--listen") -> None:
    """See that nobody on the network can take part unasked.

    Args:
        where: what says so.

    Raises:
        InputError: an endpoint that other computers reach, without keys.
    """
    if keys is None and not insecure and not is_local(text):
        raise InputError(
            f"{where}: got {text}, where other computers may come in; allowed: --keys DIR, as `swarm keys DIR` makes "
            "it, or --insecure to let in everybody"
        )


def credentials_of(keys: Path | None, name: str) -> Credentials | None:
    """What proves that one is `name`; None on an open network.

    Raises:
        InputError: the folder does not hold it.
    """
    if keys is None:
        return None
    credentials = Credentials(keys, name)
    check_complete(credentials)
    return credentials


def check_complete(credentials: Credentials) -> None:
    """See that the files are there.

    Raises:
        InputError: the folder does not hold them.
    """
    missing = ", ".join(file.name for file in credentials.missing)
    if missing:
        raise InputError(
            f"--keys: {credentials.folder} has no {missing}; `swarm keys` makes them: --agents N of them, "
            "--per-process N in one process"
        )


def check_all_known(credentials: Credentials, mission: Mission) -> None:
    """See that every agent of the mission can be let in.

    Raises:
        InputError: the world does not know some of them.
    """
    known = {uid for name in credentials.known for uid in agents_named(name)}
    strangers = [str(uid) for uid in range(mission.agents.count) if uid not in known]
    if strangers:
        raise InputError(
            f"--keys: {credentials.folder} has no certificate of agent {', '.join(strangers)}; "
            f"allowed: what `swarm keys --agents {mission.agents.count}` makes"
        )


def why(error: BusError, credentials: Credentials | None, *, otherwise: str) -> str:
    """Why nobody was reached, and what to look at."""
    if not error.refused:
        return f"{error}: {otherwise}"
    if credentials is None:
        return f"{error}: if it was started with --keys, give --keys here, too"
    return (
        f"{error}: was it started with --keys, too, and are {credentials.certificate} and its key from the same "
        "`swarm keys` as the world's?"
    )


def silence(credentials: Credentials | None) -> str:
    """What to look at when nobody answers who should, or who does is not heard: a denial is silent."""
    if credentials is None:
        return ""
    return f" (or {credentials.certificate} is not what its name says: what its owner may not say or hear is dropped)"
