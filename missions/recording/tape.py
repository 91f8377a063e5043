"""Where a recording goes: a file, and a server that a live viewer reads. Both get the same columns."""

from __future__ import annotations

from pathlib import Path

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
    """The open streams of one recording. Used by one thread only."""

    def __init__(self, *, scene: Scene) -> None:
        self._scene = scene
        self._streams: list[rr.RecordingStream] = []

    def open_file(self, path: Path, blueprint: rrb.Blueprint) -> None:
        """Record into `path`, replacing it."""
        stream = self._new_stream()
        stream.set_sinks(rr.FileSink(path), default_blueprint=blueprint)

    def open_server(self, blueprint: rrb.Blueprint) -> str:
        """Serve the recording to viewers on this machine, late ones too, and return where.

        It keeps so much for them and no more: the oldest goes first.
        """
        server = rr.GrpcServerSink(LOOPBACK, free_port(), server_memory_limit=_SERVED)
        self._new_stream().set_sinks(server, default_blueprint=blueprint)
        return str(server.uri)

    def log_static(self, path: str, *parts: rr.AsComponents) -> None:
        """Record what holds at every time."""
        for stream in self._streams:
            stream.log(path, *parts, static=True)

    def set_property(self, name: str, values: rr.AsComponents) -> None:
        """Record a property of the recording as a whole."""
        for stream in self._streams:
            stream.send_property(name, values)

    def send(self, rows: Rows) -> None:
        """Record one entity's rows; nothing when there are none."""
        if rows.block is not None and not len(rows.block):
            return
        indexes, columns = _indexes(rows.block), list(rows.columns)
        for stream in self._streams:
            stream.send_columns(rows.path, indexes=indexes, columns=columns)

    def flush(self) -> None:
        """Hand everything to the operating system: from here on it survives the death of this process."""
        for stream in self._streams:
            stream.flush(timeout_sec=_FLUSH_TIMEOUT_S)

    def close(self) -> None:
        """Flush and close the streams; the file gets its index."""
        try:
            self.flush()
        finally:
            for stream in self._streams:
                stream.disconnect()
            self._streams.clear()

    def _new_stream(self) -> rr.RecordingStream:
        # No automatic properties: they hold the wall clock, and equal missions shall give equal recordings.
        stream = rr.RecordingStream(APPLICATION_ID, recording_id=self._scene.recording_id, send_properties=False)
        stream.send_recording_name(self._scene.mission_name)
        self._streams.append(stream)
        return stream


def _indexes(block: Block | None) -> list[rr.TimeColumn]:
    if block is None:
        return []
    times = rr.TimeColumn(TIME_LINE, duration=block.times_ns.astype("timedelta64[ns]"))
    return [times, rr.TimeColumn(TICK_LINE, sequence=block.ticks)]
