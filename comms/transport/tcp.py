"""MAVLink over TCP: `tcp` connects, and again when it was cut off; `tcpin` serves several clients."""

from __future__ import annotations

import errno
import socket
from typing import Self

from comms.transport.backoff import Backoff
from comms.transport.contract import MAX_PEERS, Closing, Counts, TransportError
from comms.transport.resolve import resolved, shown
from comms.transport.stream import Stream

UNHEARD_MS = 10_000  # what a peer has not acknowledged for so long ends the connection
_BACKLOG = 8
_UNDER_WAY = (errno.EINPROGRESS, errno.EALREADY, errno.EWOULDBLOCK)
_DONE = (0, errno.EISCONN)


class Connection:
    """One open connection, either side's."""

    def __init__(self, opened: socket.socket, counts: Counts) -> None:
        opened.setblocking(False)
        opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if hasattr(socket, "TCP_USER_TIMEOUT"):
            opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, UNHEARD_MS)
        self._socket = opened
        self.stream = Stream(opened.fileno(), counts)

    def close(self) -> None:
        self._socket.close()


class TcpServer(Closing):
    """`tcpin:HOST:PORT`: every client hears everything, and what they say comes in whole frames."""

    def __init__(self, host: str, port: int) -> None:
        self._host, self._port = host, port
        self._listener: socket.socket | None = None
        self._clients: list[Connection] = []
        self.url = f"tcpin:{shown(host, port)}"
        self.counts = Counts()

    @property
    def connected(self) -> bool:
        return bool(self._clients)

    def __enter__(self) -> Self:
        try:
            family, address = resolved(self._host, self._port, socket.SOCK_STREAM)
            self._listener = socket.socket(family, socket.SOCK_STREAM)
            self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self._listener.setblocking(False)
            self._listener.bind(address)
            self._listener.listen(_BACKLOG)
        except OSError as error:
            self.close()
            raise TransportError(f"{self.url}: {error.strerror or error}") from error
        self.url = f"tcpin:{shown(self._host, self._listener.getsockname()[1])}"
        return self

    def close(self) -> None:
        for client in self._clients:
            client.close()
        self._clients.clear()
        if self._listener is not None:
            self._listener.close()
            self._listener = None

    def read(self, now_s: float) -> list[bytes]:
        self._welcome()
        chunks: list[bytes] = []
        for client in list(self._clients):
            try:
                client.stream.flush()
                chunk = client.stream.read()
            except OSError:
                self._drop(client)
                continue
            if chunk:
                chunks.append(chunk)
        return chunks

    def write(self, data: bytes) -> None:
        for client in list(self._clients):
            try:
                client.stream.write(data)
            except OSError:
                self._drop(client)

    def _welcome(self) -> None:
        """Take in who waits outside, as far as there is room."""
        if self._listener is None:
            raise ValueError(f"{self.url} is not open")
        while len(self._clients) < MAX_PEERS:
            try:
                opened, _ = self._listener.accept()
            except OSError:  # nobody waits, or one has gone again
                return
            self._clients.append(Connection(opened, self.counts))

    def _drop(self, client: Connection) -> None:
        client.close()
        self._clients.remove(client)


class TcpClient(Closing):
    """`tcp:HOST:PORT`: a connection that is made in `read`, and made again after a while when it is lost."""

    def __init__(self, host: str, port: int) -> None:
        self._host, self._port = host, port
        self._backoff = Backoff()
        self._calling: socket.socket | None = None
        self._connection: Connection | None = None
        self.url = f"tcp:{shown(host, port)}"
        self.counts = Counts()

    @property
    def connected(self) -> bool:
        return self._connection is not None

    def __enter__(self) -> Self:
        try:
            self._family, self._address = resolved(self._host, self._port, socket.SOCK_STREAM)
        except OSError as error:
            raise TransportError(f"{self.url}: {error.strerror or error}") from error
        return self

    def close(self) -> None:
        for opened in (self._calling, self._connection):
            if opened is not None:
                opened.close()
        self._calling = self._connection = None

    def read(self, now_s: float) -> list[bytes]:
        if self._connection is None and not self._connect(now_s):
            return []
        assert self._connection is not None
        try:
            self._connection.stream.flush()
            chunk = self._connection.stream.read()
        except OSError:
            self._lose()
            return []
        return [chunk] if chunk else []

    def write(self, data: bytes) -> None:
        if self._connection is None:
            self.counts.dropped_out += len(data)
            return
        try:
            self._connection.stream.write(data)
        except OSError:
            self._lose()

    def _connect(self, now_s: float) -> bool:
        """Go on with connecting. Returns whether it is done."""
        if self._calling is None:
            if not self._backoff.due(now_s):
                return False
            try:
                self._calling = socket.socket(self._family, socket.SOCK_STREAM)
            except OSError:  # too many are open
                self._lose()
                return False
            self._calling.setblocking(False)
        trouble = self._calling.connect_ex(self._address)
        if trouble in _UNDER_WAY:
            return False
        if trouble not in _DONE:
            self._lose()
            return False
        self._connection, self._calling = Connection(self._calling, self.counts), None
        self._backoff.succeeded()
        return True

    def _lose(self) -> None:
        self.close()
        self._backoff.failed()
