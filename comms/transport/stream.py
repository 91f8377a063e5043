"""One peer's end of a byte stream (a TCP connection, a serial line): whole frames out, patience with slow readers."""

from __future__ import annotations

import os

from comms.framing import whole_bytes
from comms.transport.contract import SOURCE_BYTES, WAITING_BYTES, Counts

_CHUNK_BYTES = 16_384


class Stream:
    """A file descriptor that does not block; a begun frame waits on the way in, a bounded queue on the way out."""

    def __init__(self, descriptor: int, counts: Counts) -> None:
        self._descriptor = descriptor
        self._counts = counts
        self._inbound = bytearray()
        self._outbound = bytearray()

    def read(self) -> bytes:
        """What has come up to the end of its last whole frame.

        At most SOURCE_BYTES: the rest waits in the system's buffer, and then in the sender's.

        Raises:
            OSError: the peer is gone.
        """
        taken = 0
        while taken < SOURCE_BYTES:
            try:
                chunk = os.read(self._descriptor, min(_CHUNK_BYTES, SOURCE_BYTES - taken))
            except BlockingIOError:
                break
            if not chunk:
                if taken:
                    break  # its last words first
                raise ConnectionError("closed by the other side")
            taken += len(chunk)
            self._inbound += chunk
        self._counts.received += taken
        end = whole_bytes(self._inbound)
        whole = bytes(self._inbound[:end])
        del self._inbound[:end]
        return whole

    def write(self, data: bytes) -> None:
        """Send `data` behind what still waits; all of it is dropped if too much does.

        Raises:
            OSError: the peer is gone.
        """
        if len(self._outbound) + len(data) > WAITING_BYTES:
            self._counts.dropped_out += len(data)
        else:
            self._outbound += data
        self.flush()

    def forget(self) -> None:
        """Drop what waits: who it was for has gone."""
        self._counts.dropped_out += len(self._outbound)
        self._inbound.clear()
        self._outbound.clear()

    def flush(self) -> None:
        """Send what waits, as far as the system takes it.

        Raises:
            OSError: the peer is gone.
        """
        while self._outbound:
            try:
                sent = os.write(self._descriptor, self._outbound)
            except BlockingIOError:
                return
            self._counts.sent += sent
            del self._outbound[:sent]
