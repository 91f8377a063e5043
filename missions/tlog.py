"""Telemetry logs, as ground stations keep them: every frame of one link, each behind the time it passed.

A `.tlog` is a stream of frames, in front of each eight bytes: microseconds since 1970, big-endian. MAVProxy, mavlogdump
and QGroundControl read it.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import BinaryIO

from comms.framing import frames
from missions.problems import InputError
from missions.sides.agent import AgentSide

# Mission time from one flush to the next: what a killed process loses.
FLUSH_S = 1.0
_STAMP = struct.Struct(">Q")


class Tlog:
    """One link's log: what the vehicle and its agent say to each other, in the order in which it passes.

    Args:
        file: open for writing bytes. began_unix_s: the wall clock when the mission clock was 0.

    Attributes:
        failure: why it keeps nothing any more, such as a full disk. A log never ends a flight.
    """

    def __init__(self, file: BinaryIO, *, began_unix_s: float) -> None:
        self._file = file
        self._began_us = round(began_unix_s * 1e6)
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
        stamp = _STAMP.pack(self._began_us + round(now_s * 1e6))
        for side, data in enumerate((heard, said)):
            if data:
                whole, self._rests[side] = frames(self._rests[side] + data)
                self._file.write(b"".join([stamp + frame for frame in whole]))
        if now_s >= self._flush_at_s:
            self._file.flush()
            self._flush_at_s = now_s + FLUSH_S


@contextmanager
def tlogs(folder: Path, sides: Sequence[AgentSide], *, began_unix_s: float) -> Iterator[Sequence[Tlog]]:
    """Keep a log of each agent's link in `folder`, `agent-3.tlog` for agent 3; older ones are replaced.

    Raises:
        InputError: they cannot be written there.
    """
    logs: list[Tlog] = []
    with ExitStack() as stack:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            for side in sides:
                log = Tlog((folder / f"agent-{side.uid}.tlog").open("wb"), began_unix_s=began_unix_s)
                stack.callback(log.close)
                side.tap = log.pass_on
                logs.append(log)
        except OSError as error:
            raise InputError(
                f"--tlog: got {folder}; allowed: a folder that can be written ({error.strerror})"
            ) from error
        yield logs
