"""Endpoints, as zenoh writes them: `tcp/10.0.0.5:7447`, `tls/[::1]:7447`."""

from __future__ import annotations

import re
import socket
from ipaddress import IPv6Address, ip_address
from time import monotonic

LOCAL_NAMES = ("localhost",)
MOST_PORT = 65_535
# What zenoh takes behind an address (`?...`, `#...`) is left out: it could undo what `--keys` asks for.
_PLACE = re.compile(r"(?:tcp|tls)/(?:\[(?P<bracketed>[^\[\]]+)\]|(?P<host>[^\[\]:/?#;\s]+)):(?P<port>[0-9]{1,5})")


def place_of(endpoint: str) -> tuple[str, int] | None:
    """Its host, without brackets, and port; None if it is not `tcp/ADDRESS:PORT`, or the same of `tls/`."""
    found = _PLACE.fullmatch(endpoint)
    if found is None or not 0 < int(found["port"]) <= MOST_PORT:
        return None
    if found["bracketed"] is not None:
        try:
            IPv6Address(found["bracketed"])
        except ValueError:
            return None
    return found["bracketed"] or found["host"], int(found["port"])


def is_local(endpoint: str) -> bool:
    """Whether it surely stays on this computer: no cable to be cut, and nobody else comes in."""
    if endpoint.partition("/")[0] not in ("tcp", "tls"):
        return False
    host = _address(endpoint)[0]
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host in LOCAL_NAMES


def round_trip_s(endpoint: str, *, timeout_s: float) -> float | None:
    """How long a TCP port there takes to open, whatever is spoken on it: the best of three; None if it does not."""
    host, port = _address(endpoint)
    trips_s = []
    try:
        for _ in range(3):
            began_s = monotonic()
            with socket.create_connection((host, int(port)), timeout=timeout_s):
                trips_s.append(monotonic() - began_s)
    except (OSError, ValueError, OverflowError):
        return None
    return min(trips_s)


def _address(endpoint: str) -> tuple[str, str]:
    address = endpoint.partition("/")[2].partition("?")[0].partition("#")[0]
    host, _, port = address.rpartition(":")
    return host.strip("[]"), port
