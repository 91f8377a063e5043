"""What every transport promises, and the bounds that all of them keep."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from types import TracebackType
from typing import Protocol, Self

SOURCE_BYTES = 65_536  # taken from one peer in one read; what a datagram peer sends beyond is dropped
WAITING_BYTES = 262_144  # kept for a stream peer that reads slowly; what comes then is dropped
DATAGRAM_BYTES = 1400  # fits an Ethernet frame with room for tunnels
MAX_PEERS = 32


class TransportError(OSError):
    """It cannot be opened (port taken, no such device or host); the text says which and why."""


@dataclass(slots=True)
class Counts:
    """Bytes of one transport since it was opened.

    Attributes:
        dropped_in: from a peer that sends too much, or from one peer too many.
        dropped_out: for a peer that does not keep up, or is not there.
    """

    received: int = 0
    sent: int = 0
    dropped_in: int = 0
    dropped_out: int = 0


class Closing(ABC):
    """What closes when its `with` block ends."""

    @abstractmethod
    def close(self) -> None:
        """Let everybody go. May be called twice."""

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class Transport(Protocol):
    """Bytes to and from whoever is on the other side. Used by one thread.

    Attributes:
        url: how to name it; after opening with the port or device it really has.
        counts: what went through it.
    """

    url: str
    counts: Counts

    @property
    def connected(self) -> bool:
        """Whether somebody is there: a peer that has been heard (UDP), or an open connection or line."""

    def read(self, now_s: float) -> list[bytes]:
        """What has come, without waiting. Chunks may be joined: frames of two peers never mix.

        Args:
            now_s: any clock that goes forward; a lost connection is opened again after a while on it.
        """

    def write(self, data: bytes) -> None:
        """Send whole frames to every peer, without waiting."""

    def close(self) -> None:
        """Let everybody go. May be called twice."""

    def __enter__(self) -> Self:
        """Open it.

        Raises:
            TransportError: it cannot be opened.
        """

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...
