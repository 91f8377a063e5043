"""`swarm import`: flight logs that other tools kept become recordings. Files and terminal are here."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from missions.flightlog import Entry, read_log
from missions.problems import InputError, OutputError
from missions.recording.logbook import record_log
from missions.review.words import clock


def import_logs(logs: Sequence[Path], to: Path) -> None:
    """Record one or several telemetry logs, of one or many vehicles, into one recording.

    Raises:
        InputError: a log cannot be read or has no MAVLink in it, or the recording cannot be written.
    """
    console = Console(highlight=False, markup=False, soft_wrap=True)
    entries: list[Entry] = []
    for path in logs:
        entries += _entries(path, console)
    try:
        vehicles = record_log(entries, to, name=logs[0].stem if len(logs) == 1 else f"{len(logs)} logs")
    except OutputError as error:
        raise InputError(f"--to: got {to}; allowed: a file that can be written ({error})") from error
    times_s = [entry.unix_s for entry in entries]
    who = ", ".join(vehicles) or "no vehicle"
    console.print(f"{to}: {who}, {len(entries)} messages in {clock(max(times_s) - min(times_s))}")


def _entries(path: Path, console: Console) -> Sequence[Entry]:
    try:
        log = read_log(path.read_bytes())
    except OSError as error:
        raise InputError(f"{path}: got no file that can be read ({error.strerror}); allowed: a .tlog") from error
    if not log.entries:
        raise InputError(f"{path}: got no MAVLink; allowed: a .tlog, as MAVProxy, QGroundControl or --tlog keep it")
    if log.skipped_bytes:
        console.print(f"{path}: {log.skipped_bytes} bytes are no message, and left out", style="yellow")
    return log.entries
