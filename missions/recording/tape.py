"""Where a recording goes: a file, and a server that a live viewer reads. Both get the same columns."""

from __future__ import annotations

import logging
import os
import socket
import subprocess
from pathlib import Path

import rerun as rr
import rerun.blueprint as rrb

from missions.recording.block import Block
from missions.recording.columns import Rows
from missions.recording.optimize import rerun_command
from missions.recording.scene import Scene

APPLICATION_ID = "swarm-mission-stack"
TIME_LINE, TICK_LINE = "mission_time", "tick"

_FLUSH_TIMEOUT_S = 20.0
_log = logging.getLogger(__name__)


class Tape:
    """The open streams of one recording. Used by one thread only."""

    def __init__(self, *, scene: Scene) -> None:
        self._scene = scene
        self._streams: list[rr.RecordingStream] = []
        self.live_url: str | None = None

    def open_file(self, path: Path, blueprint: rrb.Blueprint) -> None:
        """Record into `path`, replacing it."""
        stream = self._new_stream()
        stream.set_sinks(rr.FileSink(path), default_blueprint=blueprint)

    def open_live(self, blueprint: rrb.Blueprint) -> None:
        """Serve the recording to viewers on this machine, and start one. It may close, or never open: no matter."""
        server = rr.GrpcServerSink("127.0.0.1", _free_port())
        stream = self._new_stream()
        stream.set_sinks(server, default_blueprint=blueprint)
        self.live_url = server.uri
        environment = {**os.environ, "RERUN_APP_ONLY": "true"}
        command = [*rerun_command(), "--hide-welcome-screen", server.uri]
        quiet = subprocess.DEVNULL
        try:
            subprocess.Popen(command, env=environment, stdout=quiet, stderr=quiet, start_new_session=True)
        except OSError as error:
            _log.warning("no live viewer: %s; the recording goes on, open %s to watch", error, server.uri)

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


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port
