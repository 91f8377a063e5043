"""MAVLink over UDP: `udpin` listens and answers whom it has heard, `udpout` speaks first."""

from __future__ import annotations

import socket
from abc import abstractmethod
from collections.abc import Callable
from functools import partial
from typing import Any, Self

from comms.framing import datagrams
from comms.transport.contract import DATAGRAM_BYTES, MAX_PEERS, SOURCE_BYTES, Closing, Counts, TransportError
from comms.transport.resolve import resolved, shown

Peer = tuple[Any, ...]  # a socket address

PEER_SILENT_S = 60.0  # a peer that says nothing for so long has gone: a ground station beats every second
_READS = 4096  # of one call
_BUFFER_BYTES = 1 << 20


class _Datagrams(Closing):
    """What both kinds share: one socket, and batches of whole frames."""

    scheme = ""

    def __init__(self, host: str, port: int) -> None:
        self._host, self._port = host, port
        self._socket: socket.socket | None = None
        self.url = f"{self.scheme}:{shown(host, port)}"
        self.counts = Counts()

    def __enter__(self) -> Self:
        try:
            family, address = resolved(self._host, self._port, socket.SOCK_DGRAM)
            self._socket = socket.socket(family, socket.SOCK_DGRAM)
            self._socket.setblocking(False)
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER_BYTES)
            self._begin(self._socket, address)
        except OSError as error:
            self.close()
            raise TransportError(f"{self.url}: {error.strerror or error}") from error
        return self

    def close(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    @abstractmethod
    def _begin(self, opened: socket.socket, address: Peer) -> None:
        """Bind the open socket to the address, or connect it."""

    def _receive(self) -> list[tuple[Peer, bytes]]:
        """The datagrams that wait, each source's up to its share."""
        got: list[tuple[Peer, bytes]] = []
        taken: dict[Peer, int] = {}
        for _ in range(_READS):
            try:
                data, peer = self._open.recvfrom(SOURCE_BYTES)
            except BlockingIOError:
                break
            except OSError:  # an earlier datagram found nobody: UDP does not care
                continue
            taken[peer] = taken.get(peer, 0) + len(data)
            if taken[peer] > SOURCE_BYTES:
                self.counts.dropped_in += len(data)
            else:
                got.append((peer, data))
        return got

    def _count(self, size: int, send: Callable[[], int]) -> None:
        """Send a datagram of `size` bytes; one that the system does not take is lost, as on the way."""
        try:
            send()
        except OSError:  # its buffer is full, or nobody is there
            self.counts.dropped_out += size
        else:
            self.counts.sent += size

    @property
    def _open(self) -> socket.socket:
        if self._socket is None:
            raise ValueError(f"{self.url} is not open")
        return self._socket


class UdpServer(_Datagrams):
    """`udpin:HOST:PORT`: whoever has been heard within PEER_SILENT_S is a peer and hears everything."""

    scheme = "udpin"

    def __init__(self, host: str, port: int) -> None:
        super().__init__(host, port)
        self._heard_at_s: dict[Peer, float] = {}

    @property
    def connected(self) -> bool:
        return bool(self._heard_at_s)

    def _begin(self, opened: socket.socket, address: Peer) -> None:
        opened.bind(address)
        self.url = f"{self.scheme}:{shown(self._host, opened.getsockname()[1])}"

    def read(self, now_s: float) -> list[bytes]:
        chunks: list[bytes] = []
        for peer, data in self._receive():
            if peer not in self._heard_at_s and len(self._heard_at_s) >= MAX_PEERS:
                self.counts.dropped_in += len(data)
                continue
            self._heard_at_s[peer] = now_s
            self.counts.received += len(data)
            chunks.append(data)
        for peer in [peer for peer, at_s in self._heard_at_s.items() if now_s - at_s > PEER_SILENT_S]:
            del self._heard_at_s[peer]
        return chunks

    def write(self, data: bytes) -> None:
        for piece in datagrams(data, at_most=DATAGRAM_BYTES):
            for peer in self._heard_at_s:
                self._count(len(piece), partial(self._open.sendto, piece, peer))


class UdpClient(_Datagrams):
    """`udpout:HOST:PORT`: speaks to one address, and hears what comes from there alone."""

    scheme = "udpout"

    def __init__(self, host: str, port: int) -> None:
        super().__init__(host, port)
        self._heard_at_s: float | None = None

    @property
    def connected(self) -> bool:
        return self._heard_at_s is not None

    def _begin(self, opened: socket.socket, address: Peer) -> None:
        opened.connect(address)

    def read(self, now_s: float) -> list[bytes]:
        chunks = [data for _, data in self._receive()]
        if chunks:
            self._heard_at_s = now_s
            self.counts.received += sum(map(len, chunks))
        elif self._heard_at_s is not None and now_s - self._heard_at_s > PEER_SILENT_S:
            self._heard_at_s = None
        return chunks

    def write(self, data: bytes) -> None:
        for piece in datagrams(data, at_most=DATAGRAM_BYTES):
            self._count(len(piece), partial(self._open.send, piece))
