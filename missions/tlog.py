"""Telemetry logs, as ground stations keep them: every frame of one link, each behind the time it passed.

A `.tlog` is a stream of frames, in front of each eight bytes: microseconds since 1970, big-endian. MAVProxy, mavlogdump
and QGroundControl read it.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import BinaryIO

from comms.framing import frames
from missions.problems import InputError

# Mission time from one flush to the next: what a killed process loses.
FLUSH_S = 1.0
_STAMP = struct.Struct(">Q")


class Tlog:
    """One link's log: what the vehicle and its agent say to each other, in the order in which it passes.

    Args:
        file: open for writing bytes. began_unix_s: the wall clock when the mission clock was 0; None: such that what
            comes first comes now.

    Attributes:
        failure: why it keeps nothing any more, such as a full disk. A log never ends a flight.
    """

    def __init__(self, file: BinaryIO, *, began_unix_s: float | None) -> None:
        self._file = file
        self._began_unix_s = began_unix_s
        self._rests = [b"", b""]  # frames begun: the vehicle's, the agent's
        self._flush_at_s = FLUSH_S
        self.failure: OSError | None = None

    def pass_on(self, now_s: float, heard: bytes, said: bytes) -> None:
        """Keep what the vehicle has said until `now_s` on the mission clock, and what its agent said then.

        A frame that is not whole waits for its end; what is no frame is left out, for a log has no place for it.
        """
        if self.failure is None:
            try:
                self._keep(now_s, heard, said)
            except OSError as error:
                self.failure = error

    def close(self) -> None:
        """Close the file."""
        try:
            self._file.close()
        except OSError as error:
            self.failure = self.failure or error

    def _keep(self, now_s: float, heard: bytes, said: bytes) -> None:
        if self._began_unix_s is None:
            self._began_unix_s = time.time() - now_s
        stamp = _STAMP.pack(round(self._began_unix_s * 1e6) + round(now_s * 1e6))
        for side, data in enumerate((heard, said)):
            if data:
                whole, self._rests[side] = frames(self._rests[side] + data)
                self._file.write(b"".join([stamp + frame for frame in whole]))
        if now_s >= self._flush_at_s:
            self._file.flush()
            self._flush_at_s = now_s + FLUSH_S


def log_of(folder: Path, uid: int) -> Path:
    """The log of one agent's link."""
    return folder / f"agent-{uid}.tlog"


def failures(logs: Iterable[Tlog]) -> list[str]:
    """Why some of these are not whole, now that they are closed."""
    return sorted({f"the telemetry logs are not whole: {log.failure}" for log in logs if log.failure is not None})


@contextmanager
def tlogs(
    folder: Path | None, uids: Iterable[int], *, began_unix_s: float | None, adds: bool = False
) -> Iterator[Mapping[int, Tlog]]:
    """A log of each of these agents' links in `folder`, `agent-3.tlog` for agent 3; none without a folder.

    Args:
        adds: to older ones, for an agent may come back to a mission that is under way; else they are replaced.

    Raises:
        InputError: they cannot be written there.
    """
    if folder is None:
        yield {}
        return
    logs: dict[int, Tlog] = {}
    with ExitStack() as stack:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            for uid in uids:
                file = log_of(folder, uid).open("ab" if adds else "wb")
                logs[uid] = Tlog(file, began_unix_s=began_unix_s)
                stack.callback(logs[uid].close)
        except OSError as error:
            raise InputError(
                f"--tlog: got {folder}; allowed: a folder that can be written ({error.strerror})"
            ) from error
        yield logs
