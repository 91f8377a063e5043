"""The files of a recording, written one after the other."""

from __future__ import annotations

import logging
import os
import threading
from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory

from missions.recording.blueprint import blueprint
from missions.recording.crashed import keep_crashed
from missions.recording.names import later, numbered, unfinished
from missions.recording.optimize import optimize
from missions.recording.scene import Scene
from missions.recording.stage import set_stage
from missions.recording.tape import APPLICATION_ID, Tape

# So long is a part of a small swarm; a large swarm's is shorter. An open file remembers where everything lies in it:
# 36 MB of memory for each minute of 10 agents over 10 targets.
_PART_S = 900.0
_SMALL_SWARM = 100  # agents and targets
_SHORTEST_S = 60.0
_log = logging.getLogger(__name__)


def usual_part_s(scene: Scene) -> float:
    """The mission time that one file of this swarm should hold at most, seconds."""
    return max(_SHORTEST_S, _PART_S * min(1.0, _SMALL_SWARM / (scene.n_agents + scene.n_targets)))


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
            keep_crashed(self._path)
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
            for old in chain.from_iterable(later(self._path)):
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


def _pack(path: Path, views: Sequence[Path]) -> None:
    try:
        optimize(path, path, views=views)
    except RuntimeError as error:
        _log.warning("%s; the recording is complete, but larger than need be", error)
