"""The files of one recording: `F.rrd`, and where a mission was long `F.0002.rrd`, `F.0003.rrd`, one after the other.

What is being written has `.part` behind its name. Whoever asks for `F.rrd` gets all of them.
"""

from __future__ import annotations

import logging
import os
import threading
from collections.abc import Iterator, Sequence
from itertools import chain, count, takewhile
from pathlib import Path
from tempfile import TemporaryDirectory

from missions.recording.blueprint import blueprint
from missions.recording.optimize import optimize
from missions.recording.repair import repair
from missions.recording.scene import Scene
from missions.recording.stage import set_stage
from missions.recording.tape import APPLICATION_ID, Tape

# So long is a part of a small swarm; a large swarm's is shorter. An open file remembers where everything lies in it:
# 36 MB of memory for each minute of 10 agents over 10 targets.
_PART_S = 900.0
_SMALL_SWARM = 100  # agents and targets
_SHORTEST_S = 60.0
_UNFINISHED = ".part"
_log = logging.getLogger(__name__)


def usual_part_s(scene: Scene) -> float:
    """The mission time that one file of this swarm should hold at most, seconds."""
    return max(_SHORTEST_S, _PART_S * min(1.0, _SMALL_SWARM / (scene.n_agents + scene.n_targets)))


def unfinished(path: Path) -> Path:
    """What a file is called while it is written."""
    return path.with_name(path.name + _UNFINISHED)


def numbered(path: Path, number: int) -> Path:
    """The `number`-th file, from 1, of the recording `path`."""
    return path if number == 1 else path.with_name(f"{path.stem}.{number:04d}{path.suffix}")


def parts_of(path: Path) -> Sequence[Path]:
    """`path` and the files that go on where it ends; the last may be unfinished."""
    return [path, *chain.from_iterable(files[:1] for files in _later(path))]


def _later(path: Path) -> Iterator[Sequence[Path]]:
    """For each further part, until one is missing, the files that are there: finished, being written, or both."""
    first = path.with_name(path.name.removesuffix(_UNFINISHED))
    names = (numbered(first, number) for number in count(2))
    files = ([part for part in (name, unfinished(name)) if part.is_file()] for name in names)
    return takewhile(bool, files)


class Parts:
    """The files of a recording while it is recorded.

    Args:
        path: the first file. part_s: the mission time that one file holds.

    Attributes:
        written_bytes: how much was written, before it was packed.
    """

    def __init__(self, path: Path, scene: Scene, *, part_s: float) -> None:
        self._path, self._scene = path, scene
        self._ticks = max(1, round(part_s / scene.tick_s))
        self._number = 0
        self._packing: list[threading.Thread] = []
        self._folder = TemporaryDirectory(prefix="swarm-record-")
        self.tape: Tape
        self.written_bytes = 0

    @property
    def being_written(self) -> Path:
        """The file that grows."""
        return unfinished(numbered(self._path, self._number))

    def is_full(self, tick: int) -> bool:
        """Whether the tick belongs into a later part."""
        return tick >= self._ticks * self._number

    def begin(self) -> None:
        """Open the next part. Once it is packed, it can be opened without the others.

        The first part has its view from the beginning. The others get it when they are packed: rerun keeps two threads
        of each view that goes the usual way until the process ends.
        """
        self._number += 1
        if self._number == 1:
            if self.being_written.exists():
                self._keep_the_crashed()
            self.tape = Tape(self._scene)
            self.tape.write(self.being_written, blueprint(self._scene, live=False))
        else:
            if self._number == 2:
                blueprint(self._scene, live=False).save(APPLICATION_ID, str(self._view))
            self.tape.write(self.being_written)
        set_stage(self.tape, self._scene)

    def end(self) -> None:
        """Close this part and have it packed meanwhile. It is whole from here on."""
        self.tape.close()
        self.written_bytes += self.being_written.stat().st_size
        path = numbered(self._path, self._number)
        if self._number == 1:
            # What an older recording of this name left would be taken for parts of this one.
            for old in chain.from_iterable(_later(self._path)):
                old.unlink()
        os.replace(self.being_written, path)
        views = [] if self._number == 1 else [self._view]
        thread = threading.Thread(target=_pack, args=(path, views), name="packer", daemon=True)
        thread.start()
        self._packing.append(thread)

    def await_packed(self) -> None:
        """Until all that has ended is packed."""
        for thread in self._packing:
            thread.join()
        self._folder.cleanup()

    @property
    def _view(self) -> Path:
        return Path(self._folder.name) / "view.rbl"

    def _keep_the_crashed(self) -> None:
        """The flight before never ended, and its recording may be what somebody will ask for."""
        kept = self._path.with_name(f"{self._path.stem}.crashed{self._path.suffix}")
        try:
            repair(self.being_written, kept)
            _log.warning("%s, of a flight that never ended, is now %s", self.being_written, kept)
        except RuntimeError as error:
            _log.warning("%s, of a flight that never ended, is replaced: %s", self.being_written, error)


def _pack(path: Path, views: Sequence[Path]) -> None:
    try:
        optimize(path, path, views=views)
    except RuntimeError as error:
        _log.warning("%s; the recording is complete, but larger than need be", error)
