"""Telemetry logs written as one recording, however long they are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from heapq import merge
from itertools import chain, islice, repeat
from pathlib import Path
from typing import NamedTuple

import rerun as rr

from missions.flightlog import Entry
from missions.problems import OutputError
from missions.recording.logbook import Logbook, is_vehicle, sender_of
from missions.recording.names import unfinished
from missions.recording.optimize import optimize
from missions.recording.tape import APPLICATION_ID

_STRETCH = 20_000  # messages that are in memory at a time


class Imported(NamedTuple):
    """What became of the logs: who is in the recording, and how long it is."""

    vehicles: Sequence[str]
    duration_s: float


class SameNameError(Exception):
    """Both would be one vehicle in a recording, that jumps from one place to another."""

    def __init__(self, vehicle: str, logs: tuple[int, int]) -> None:
        super().__init__(vehicle, logs)
        self.vehicle, self.logs = vehicle, logs


def record_logs(logs: Sequence[Iterable[Entry]], path: Path, *, name: str) -> Imported:
    """Write the messages of logs, each in order of time and one of them not empty, as a recording.

    Raises:
        SameNameError: two logs have vehicles of one system id at the same time.
        OutputError: it cannot be written.
    """
    part = unfinished(path)
    stream = rr.RecordingStream(APPLICATION_ID, send_properties=False)
    entries = _in_order(logs)
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


def _in_order(logs: Sequence[Iterable[Entry]]) -> Iterator[Entry]:
    """Messages of all logs in order of time. A vehicle may go on in another log, but not come back in the first."""
    numbered = (zip(repeat(number), log) for number, log in enumerate(logs))
    heard_in: dict[str, list[int]] = {}
    for number, entry in merge(*numbered, key=lambda pair: pair[1].unix_s):
        sender = sender_of(entry.message)
        if is_vehicle(sender):
            so_far = heard_in.setdefault(sender, [number])
            if number not in so_far:
                so_far.append(number)
            elif number != so_far[-1]:
                raise SameNameError(sender, (number, so_far[-1]))
        yield entry
