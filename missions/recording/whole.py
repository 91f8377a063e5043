"""A recording as files that can be read: as they are, or with a repaired copy of one that was never finished."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from rerun.chunk import RrdReader

from missions.problems import InputError
from missions.recording.parts import parts_of, unfinished
from missions.recording.repair import repair


@contextmanager
def whole(path: Path) -> Iterator[tuple[Sequence[Path], bool]]:
    """The files to read, and whether one is a repaired copy, which is gone afterwards; the recording stays as it is.

    Raises:
        InputError: there is no such file, or nothing of it can be read.
    """
    if not path.is_file():
        part = unfinished(path)
        hint = f"; did you mean {part}?" if part.is_file() else ""
        raise InputError(f"{path}: got no file; allowed: a recording, F.rrd or F.rrd.part{hint}")
    if path.suffix == ".tlog":
        raise InputError(f"{path}: got a telemetry log; allowed: a recording, which swarm import makes of it")
    with TemporaryDirectory(prefix="swarm-review-") as folder:
        parts = parts_of(path)
        files = [file for part in parts if (file := _readable(part, Path(folder), needed=part == path)) is not None]
        yield files, files != parts


def _readable(path: Path, folder: Path, *, needed: bool) -> Path | None:
    """The file, or a repaired copy of it; None if it may be missing: a last part of which nothing was written yet."""
    if _is_whole(path):
        return path
    copy = folder / path.name
    try:
        repair(path, copy)
    except RuntimeError as error:
        if not needed:
            return None
        raise InputError(f"{path}: got no recording ({error}); allowed: F.rrd or F.rrd.part") from error
    return copy if needed or _is_whole(copy) else None


def _is_whole(path: Path) -> bool:
    """Whether it has the index that is written last, and all that the index speaks of can be read."""
    try:
        with warnings.catch_warnings(action="ignore"):
            for _ in RrdReader(path).store().stream():
                pass
    except (RuntimeError, ValueError):
        return False
    return True
