"""Where a recording goes: into a file, or to a server that a live viewer reads."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from missions.recording.block import Block
from missions.recording.columns import Rows
from missions.recording.scene import Scene
from missions.recording.watch import LOOPBACK, free_port

APPLICATION_ID = "swarm-mission-stack"
TIME_LINE, TICK_LINE = "mission_time", "tick"

_FLUSH_TIMEOUT_S = 20.0
_SERVED = "1GiB"


class Tape:
    """An open stream of a recording, into one file after the other. Used by one thread at a time."""

    def __init__(self, scene: Scene) -> None:
        # No automatic properties: they hold the wall clock, and equal missions shall give equal recordings.
        # One stream serves all files: rerun keeps the threads of each until the process ends.
        self._stream = rr.RecordingStream(APPLICATION_ID, recording_id=scene.recording_id, send_properties=False)
        self._name = scene.mission_name

    def write(self, path: Path, blueprint: rrb.Blueprint | None = None) -> None:
        """Record into `path`, replacing it; with the view, if there is one."""
        self._stream.set_sinks(rr.FileSink(path), default_blueprint=blueprint)
        self._stream.send_recording_name(self._name)

    def serve(self, blueprint: rrb.Blueprint) -> str:
        """Serve the recording to viewers on this machine, late ones too, and return where.

        It keeps so much for them and no more: the oldest goes first.
        """
        server = rr.GrpcServerSink(LOOPBACK, free_port(), server_memory_limit=_SERVED)
        self._stream.set_sinks(server, default_blueprint=blueprint)
        self._stream.send_recording_name(self._name)
        return str(server.uri)

    def log_static(self, path: str, *parts: rr.AsComponents) -> None:
        """Record what holds at every time."""
        self._stream.log(path, *parts, static=True)

    def set_property(self, name: str, values: rr.AsComponents) -> None:
        """Record a property of the recording as a whole."""
        self._stream.send_property(name, values)

    def send(self, rows: Rows) -> None:
        """Record one entity's rows."""
        self._stream.send_columns(rows.path, indexes=_indexes(rows.block), columns=rows.columns)

    def flush(self) -> None:
        """Hand everything to the operating system: from here on it survives the death of this process."""
        self._stream.flush(timeout_sec=_FLUSH_TIMEOUT_S)

    def close(self) -> None:
        """Flush, and close what is written now; a file gets its index."""
        try:
            self.flush()
        finally:
            self._stream.disconnect()


def _indexes(block: Block) -> list[rr.TimeColumn]:
    return _columns(block.times_ns.tobytes(), block.ticks.tobytes())


@lru_cache(maxsize=16)  # most entities are drawn at the same few ticks
def _columns(times_ns: bytes, ticks: bytes) -> list[rr.TimeColumn]:
    times = rr.TimeColumn(TIME_LINE, duration=np.frombuffer(times_ns, "timedelta64[ns]"))
    return [times, rr.TimeColumn(TICK_LINE, sequence=np.frombuffer(ticks, np.int64))]
