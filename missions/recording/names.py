"""The files of one recording: `F.rrd`, and where a mission was long `F.0002.rrd`, `F.0003.rrd`, one after the other.

What is being written has `.part` behind its name. Whoever asks for `F.rrd` gets all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain, count, takewhile
from pathlib import Path

_UNFINISHED = ".part"


def unfinished(path: Path) -> Path:
    """What a file is called while it is written."""
    return path.with_name(path.name + _UNFINISHED)


def is_unfinished(part: Path) -> bool:
    """Whether the file was never finished, or is being written."""
    return part.name.endswith(_UNFINISHED)


def numbered(path: Path, number: int) -> Path:
    """The `number`-th file, from 1, of the recording `path`."""
    return path if number == 1 else path.with_name(f"{path.stem}.{number:04d}{path.suffix}")


def parts_of(path: Path) -> Sequence[Path]:
    """`path` and the files that go on where it ends; the last may be unfinished."""
    return [path, *chain.from_iterable(files[:1] for files in later(path))]


def begins_in(path: Path) -> Path:
    """The file in which the recording `path` begins by now: it is unfinished until the first part is closed."""
    part = unfinished(path)
    return part if part.is_file() else path


def later(path: Path) -> Iterator[Sequence[Path]]:
    """For each further part, until one is missing, the files that are there: finished, being written, or both."""
    first = path.with_name(path.name.removesuffix(_UNFINISHED))
    names = (numbered(first, number) for number in count(2))
    files = ([part for part in (name, unfinished(name)) if part.is_file()] for name in names)
    return takewhile(bool, files)
