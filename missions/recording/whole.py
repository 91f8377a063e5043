"""A recording as files that can be read: as they are, or with a repaired copy of one that was never finished."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from rerun.chunk import RrdReader

from missions.problems import InputError
from missions.recording.names import parts_of, unfinished
from missions.recording.repair import repair

# What stands before the very end of a file, behind the index; a file that was not closed has no index.
_FOOTER = b"RRF2FOOT"
_FOOTER_BYTES = 64


@dataclass(frozen=True, slots=True)
class Whole:
    """A recording that can be read.

    Attributes:
        files: one after the other; copies among them are gone afterwards, and the recording stays as it is.
        unfinished: the last one was never closed. damaged: places that could not be read, and are left out.
    """

    files: Sequence[Path]
    unfinished: bool
    damaged: int


@contextmanager
def whole(path: Path) -> Iterator[Whole]:
    """The files of a recording, repaired where needed.

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
        files, damaged = [], 0
        for number, part in enumerate(parts):
            file, lost = _readable(part, Path(folder) / f"{number}.rrd", needed=part == path)
            damaged += lost
            if file is not None:
                files.append(file)
        yield Whole(files, not all(map(_is_closed, parts)), damaged)


def _readable(path: Path, copy: Path, *, needed: bool) -> tuple[Path | None, int]:
    """The file, or a repaired copy of it; None if it may be missing: a last part of which nothing was written yet.

    And in how many places it is damaged.
    """
    plain = path
    if not str(path).isprintable():  # rerun opens no file whose name is not UTF-8
        plain = copy.with_name(f"link-{copy.name}")
        plain.symlink_to(path.resolve())
    if _is_whole(plain):
        return plain, 0
    try:
        damaged = repair(path, copy)
    except RuntimeError as error:
        if not needed:
            return None, 0
        raise InputError(f"{path}: got no recording ({error}); allowed: F.rrd or F.rrd.part") from error
    if _is_closed(path):  # it needed no repair for its end
        damaged = max(1, damaged)
    return (copy if needed or _is_whole(copy) else None), damaged


def _is_closed(path: Path) -> bool:
    """Whether its writer came to the end."""
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - _FOOTER_BYTES))
        return _FOOTER in file.read()


def _is_whole(path: Path) -> bool:
    """Whether all that its index speaks of can be read."""
    try:
        with warnings.catch_warnings(action="ignore"):
            for _ in RrdReader(path).store().stream():
                pass
    except (RuntimeError, ValueError):
        return False
    return True
