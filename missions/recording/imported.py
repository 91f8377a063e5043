"""Telemetry logs written as one recording, however long they are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from heapq import merge
from itertools import chain, islice
from pathlib import Path
from typing import NamedTuple

import rerun as rr

from missions.flightlog import Entry
from missions.problems import OutputError
from missions.recording.logbook import Logbook
from missions.recording.optimize import optimize
from missions.recording.parts import unfinished
from missions.recording.tape import APPLICATION_ID

_STRETCH = 20_000  # messages that are in memory at a time


class Imported(NamedTuple):
    """What became of the logs: who is in the recording, and how long it is."""

    vehicles: Sequence[str]
    duration_s: float


def record_logs(logs: Sequence[Iterable[Entry]], path: Path, *, name: str) -> Imported:
    """Write the messages of logs, each in order of time and one of them not empty, as a recording.

    Raises:
        OutputError: it cannot be written.
    """
    part = unfinished(path)
    stream = rr.RecordingStream(APPLICATION_ID, send_properties=False)
    entries: Iterator[Entry] = merge(*logs, key=lambda entry: entry.unix_s)
    first = next(entries)
    logbook = Logbook(stream, began_s=first.unix_s)
    ended_s = first.unix_s
    try:
        stream.set_sinks(rr.FileSink(part))
        stream.send_recording_name(name)
        stream.log("/world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        entries = chain((first,), entries)
        while stretch := list(islice(entries, _STRETCH)):
            logbook.write(stretch)
            ended_s = max(ended_s, stretch[-1].unix_s)
        logbook.finish()
        stream.flush()
        stream.disconnect()
        optimize(part, path)
    except (OSError, RuntimeError) as error:
        raise OutputError(f"cannot record to {path}: {error}") from error
    finally:
        part.unlink(missing_ok=True)
    return Imported(sorted(logbook.vehicles), ended_s - first.unix_s)
