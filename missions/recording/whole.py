"""A recording as a file that can be read: as it is, or a repaired copy of one that was never finished."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from rerun.chunk import RrdReader

from missions.problems import InputError
from missions.recording.optimize import optimize


@contextmanager
def whole(path: Path) -> Iterator[tuple[Path, bool]]:
    """The file to read, and whether it is a repaired copy, which is gone afterwards; the recording stays as it is.

    Raises:
        InputError: there is no such file, or nothing of it can be read.
    """
    if not path.is_file():
        part = path.with_name(path.name + ".part")
        hint = f"; did you mean {part}?" if part.is_file() else ""
        raise InputError(f"{path}: got no file; allowed: a recording, F.rrd or F.rrd.part{hint}")
    if path.suffix == ".tlog":
        raise InputError(f"{path}: got a telemetry log; allowed: a recording, which swarm import makes of it")
    if _is_whole(path):
        yield path, False
        return
    with TemporaryDirectory(prefix="swarm-review-") as folder:
        copy = Path(folder) / "repaired.rrd"
        try:
            optimize(path, copy)
        except RuntimeError as error:
            raise InputError(f"{path}: got no recording ({error}); allowed: F.rrd or F.rrd.part") from error
        yield copy, True


def _is_whole(path: Path) -> bool:
    """Whether it has the index that is written last."""
    try:
        with warnings.catch_warnings(action="ignore"):
            RrdReader(path).store()
    except (RuntimeError, ValueError):
        return False
    return True
