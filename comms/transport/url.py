"""How a user names a transport: `tcp:127.0.0.1:5760`, `udpin:0.0.0.0:14550`, `serial:/dev/ttyACM0:115200`, `pty`."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from comms.transport.contract import Transport
from comms.transport.serial_line import PseudoTerminal, SerialLine
from comms.transport.tcp import TcpClient, TcpServer
from comms.transport.udp import UdpClient, UdpServer

_FASTEST_BAUD = 4_000_000


class Form(NamedTuple):
    """One kind: how it is written, and what to make of that which stands behind the first colon."""

    form: str
    make: Callable[[str], Transport]


def transport_of(url: str) -> Transport:
    """The transport that `url` names, not yet open.

    Raises:
        ValueError: it names none; the text says what was given and what is allowed.
    """
    scheme, _, rest = url.partition(":")
    known = _KINDS.get(scheme)
    if known is None:
        raise ValueError(f'got "{url}"; allowed: {FORMS}')
    try:
        return known.make(rest)
    except ValueError as error:
        raise ValueError(f'got "{url}"; allowed: {known.form}{error}') from None


def _listening(make: Callable[[str, int], Transport]) -> Callable[[str], Transport]:
    """A port of ours: 0 is one that is free."""
    return lambda rest: make(*_host_port(rest, lowest=0))


def _calling(make: Callable[[str, int], Transport]) -> Callable[[str], Transport]:
    return lambda rest: make(*_host_port(rest, lowest=1))


def _host_port(text: str, *, lowest: int) -> tuple[str, int]:
    host, colon, port = text.rpartition(":")
    host = host.removeprefix("[").removesuffix("]") if host.startswith("[") else host
    if not (colon and host and not host.isspace()):
        raise ValueError
    return host, _number(port, lowest=lowest, highest=65_535, what="a port")


def _serial(rest: str) -> Transport:
    device, colon, baud = rest.rpartition(":")
    if not (colon and device):
        raise ValueError
    return SerialLine(device, _number(baud, lowest=1, highest=_FASTEST_BAUD, what="a baud rate"))


def _number(text: str, *, lowest: int, highest: int, what: str) -> int:
    if not (text.isascii() and text.isdigit() and lowest <= int(text[:9]) <= highest and len(text) <= 9):
        raise ValueError(f", with {what} from {lowest} to {highest}")
    return int(text)


_KINDS: dict[str, Form] = {
    "tcp": Form("tcp:HOST:PORT", _calling(TcpClient)),
    "tcpin": Form("tcpin:HOST:PORT", _listening(TcpServer)),
    "udpin": Form("udpin:HOST:PORT", _listening(UdpServer)),
    "udpout": Form("udpout:HOST:PORT", _calling(UdpClient)),
    "serial": Form("serial:DEVICE:BAUD", _serial),
    "pty": Form("pty or pty:PATH", PseudoTerminal),
}
FORMS = ", ".join(known.form for known in _KINDS.values())
