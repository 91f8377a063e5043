"""Hosts: how a name becomes a socket address, and how an address is shown."""

from __future__ import annotations

import socket
from typing import Any


def resolved(host: str, port: int, kind: int) -> tuple[int, tuple[Any, ...]]:
    """The family and the address of the first that `host` has.

    Raises:
        OSError: no such host.
    """
    family, _, _, _, address = socket.getaddrinfo(host, port, type=kind)[0]
    return family, address


def shown(host: str, port: int) -> str:
    """HOST:PORT, an IPv6 address in brackets."""
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"
