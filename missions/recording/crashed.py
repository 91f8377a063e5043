"""What a flight that never ended left of its recording is kept under another name: it may be what somebody asks for."""

from __future__ import annotations

import logging
import os
from itertools import chain
from pathlib import Path

from missions.recording.names import begins_in, is_unfinished, later, numbered, parts_of, unfinished
from missions.recording.repair import repair

_log = logging.getLogger(__name__)


def keep_crashed(path: Path) -> None:
    """Make `F.crashed.rrd`, of as many files as there are, of a recording `F.rrd` that was never finished.

    An older one of that name is replaced.
    """
    first = begins_in(path)
    # Behind a first file that is not finished are those of a flight before, which was.
    parts = [part for part in (parts_of(path) if first == path else [first]) if part.is_file()]
    if not any(map(is_unfinished, parts)):
        return
    kept = path.with_name(f"{path.stem}.crashed{path.suffix}")
    for old in (kept, unfinished(kept), *chain.from_iterable(later(kept))):
        old.unlink(missing_ok=True)
    for number, part in enumerate(parts, start=1):
        place = _kept(part, numbered(kept, number))
        _log.warning("%s, of a flight that never ended, is now %s", part, place)


def _kept(part: Path, place: Path) -> Path:
    """Where the file is now: repaired, if that can be and need be."""
    if is_unfinished(part):
        try:
            repair(part, place)
        except RuntimeError:
            place = unfinished(place)
        else:
            part.unlink()
            return place
    os.replace(part, place)
    return place
