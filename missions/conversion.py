"""`swarm import`: flight logs that other tools kept become recordings. Files and terminal are here."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from mmap import ACCESS_READ, mmap
from pathlib import Path

from rich.console import Console

from missions.flightlog import FlightLog
from missions.problems import InputError, OutputError
from missions.recording.imported import SameNameError, record_logs
from missions.review.words import clock

MOST_BACK_S = 1.0  # what nobody need be told of: a clock was set right


def import_logs(paths: Sequence[Path], to: Path) -> None:
    """Record one or several telemetry logs, of one or many vehicles, into one recording.

    Raises:
        InputError: a log cannot be read or has no MAVLink in it, or the recording cannot be written.
    """
    if to.suffix != ".rrd" or to.resolve() in {path.resolve() for path in paths}:
        raise InputError(f"--to: got {to}; allowed: a file that ends with .rrd, and is none of the logs")
    console = Console(highlight=False, markup=False, soft_wrap=True)
    with ExitStack() as stack:
        logs = [stack.enter_context(_opened(path)) for path in paths]
        try:
            name = _in_unicode(paths[0].stem) if len(paths) == 1 else f"{len(paths)} logs"
            imported = record_logs(logs, to, name=name)
        except SameNameError as both:
            first, second = (paths[number] for number in both.logs)
            raise InputError(
                f"{first} and {second}: got vehicles of one system id ({both.vehicle}) at the same time; "
                "allowed: one log of each vehicle at a time, so import them one by one"
            ) from both
        except OutputError as error:
            raise InputError(f"--to: got {to}; allowed: a file that can be written ({error})") from error
        for path, log in zip(paths, logs, strict=True):
            if log.skipped_bytes:
                console.print(f"{path}: {log.skipped_bytes} bytes are no message, and left out", style="yellow")
            if log.back_s > MOST_BACK_S:
                told = f"its time goes back, by up to {log.back_s:.1f} s: what came twice lies one over the other"
                console.print(f"{path}: {told}", style="yellow")
    who = ", ".join(imported.vehicles) or "no vehicle"
    console.print(f"{to}: {who}, {sum(log.messages for log in logs)} messages in {clock(imported.duration_s)}")


@contextmanager
def _opened(path: Path) -> Iterator[FlightLog]:
    """A log with a message in it. It is read from the file as it is asked for."""
    try:
        with path.open("rb") as file:
            data = mmap(file.fileno(), 0, access=ACCESS_READ) if path.stat().st_size else b""
    except OSError as error:
        raise InputError(f"{path}: got no file that can be read ({error.strerror}); allowed: a .tlog") from error
    if next(iter(FlightLog(data)), None) is None:
        raise InputError(f"{path}: got no MAVLink; allowed: a .tlog, as MAVProxy, QGroundControl or --tlog keep it")
    try:
        yield FlightLog(data)
    finally:
        if isinstance(data, mmap):
            data.close()


def _in_unicode(name: str) -> str:
    """A file's name without the bytes that are no UTF-8."""
    return name.encode(errors="replace").decode()
