"""The recorder: a bounded queue, and behind it one thread that draws every observation."""

from __future__ import annotations

import logging
import threading
from pathlib import Path
from types import TracebackType

from missions.observation import Observation
from missions.problems import OutputError
from missions.recording.block import Block
from missions.recording.blueprint import blueprint
from missions.recording.charts import Metrics, Telemetry
from missions.recording.columns import Layer, TellsChanges
from missions.recording.ground import SeenGround
from missions.recording.hazards import Hazards
from missions.recording.intake import Intake
from missions.recording.ledger import Ledger
from missions.recording.messages import Messages
from missions.recording.minds import Minds
from missions.recording.parts import Parts, usual_part_s
from missions.recording.places import Places
from missions.recording.relations import Relations
from missions.recording.scene import Scene
from missions.recording.stage import set_stage
from missions.recording.story import EventLog, Lanes
from missions.recording.swarm import Swarm
from missions.recording.tape import Tape
from missions.recording.targets import Targets
from missions.recording.watch import WebPage, open_window

_QUEUED_S = 5.0
# Mission time from one flush to the next: what a killed process loses, and what a live viewer lags behind.
_FLUSH_S, _LIVE_FLUSH_S = 1.0, 0.5
_LAYERS = (
    SeenGround, Swarm, Targets, Relations, Lanes, EventLog, Metrics, Telemetry, Places, Minds, Messages,
    Hazards, Ledger,
)  # fmt: skip
_log = logging.getLogger(__name__)


class RecordingError(OutputError):
    """The recorder failed; the mission did not. The cause says why."""


class Recorder:
    """Records a mission into a file, `F.rrd.part` while it runs and `F.rrd` once it is whole; a long one into several.

    Args:
        path: the recording, in a folder that exists; a file of that name is replaced at the end. None keeps nothing.
        scene: what stands still.
        view: show it in a viewer's window, live. web: serve a page that shows it, live, to browsers on this machine.
        lossless: wait when the recorder is behind, so that the recording is complete and repeats exactly (lockstep);
            else drop the observation and count it (real time).
        part_s: the mission time that one file holds; None: what takes about half a gigabyte of memory.

    Attributes:
        server_url: where a viewer on this machine can join in, and page_url: the page for browsers; None if not live.

    A killed process loses what was not flushed: a second in real time; as fast as it goes what waits in the queue,
    too, some seconds of mission. `swarm review` repairs what it leaves.
    """

    def __init__(
        self,
        path: Path | str | None,
        *,
        scene: Scene,
        view: bool = False,
        web: bool = False,
        lossless: bool = True,
        part_s: float | None = None,
    ) -> None:
        self.path = None if path is None else Path(path)
        self.server_url: str | None = None
        self.page_url: str | None = None
        self._page: WebPage | None = None
        self._scene = scene
        self._view, self._web = view, web
        self._parts = None if self.path is None else Parts(self.path, scene, part_s=part_s or usual_part_s(scene))
        self._live: Tape | None = None
        self._intake = Intake(max(2, round(_QUEUED_S * scene.ticks_per_s)), lossless=lossless)
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)
        self._error: BaseException | None = None

    def __enter__(self) -> Recorder:
        """Open the file and start the thread.

        Raises:
            RecordingError: the file cannot be written.
        """
        try:
            if self._parts is not None:
                self._parts.begin()
            if self._is_live:
                self._live = Tape(self._scene)
                self.server_url = self._live.serve(blueprint(self._scene, live=True))
                set_stage(self._live, self._scene)
        except Exception as error:
            self._error = error
            self._close()
            where = "a viewer" if self._parts is None else self._parts.being_written
            raise RecordingError(f"cannot record to {where}: {error}") from error
        self._show()
        self._thread.start()
        return self

    @property
    def dropped(self) -> int:
        """Observations that came too fast."""
        return self._intake.dropped

    @property
    def has_failed(self) -> bool:
        """Whether nothing is recorded any more; the end of it says why."""
        return self._error is not None

    @property
    def being_written(self) -> Path | None:
        """The file that grows; None if there is none."""
        return None if self._parts is None else self._parts.being_written

    @property
    def written_bytes(self) -> int:
        """How long the file was before it was optimized."""
        return 0 if self._parts is None else self._parts.written_bytes

    @property
    def _tapes(self) -> list[Tape]:
        files = [] if self._parts is None else [self._parts.tape]
        return files if self._live is None else [*files, self._live]

    @property
    def _is_live(self) -> bool:
        return self._view or self._web

    def _show(self) -> None:
        if self.server_url is not None and self._view:
            open_window(self.server_url)
        if self.server_url is not None and self._web:
            self._page = WebPage(self.server_url)
            self.page_url = self._page.url

    def observe(self, observation: Observation) -> None:
        """Record one tick. Costs the caller a queue entry; never raises on account of the recording."""
        self._intake.put(observation)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Finish the file. Where nothing was observed there is none, and an older one stays.

        Raises:
            RecordingError: something went wrong while recording, unless the mission itself failed: then it is logged.
        """
        self._intake.end()
        self._thread.join()
        try:
            self._finish()
        except RecordingError as failure:
            if kind is None:
                raise
            _log.error("%s", failure)

    def _finish(self) -> None:
        if self._page is not None:
            self._page.close()
        try:
            self._close()
        except Exception as error:
            self._error = self._error or error
        if self._error is not None:
            remains = "" if self._parts is None else f", what there is lies in {self._parts.being_written}"
            raise RecordingError(f"recording failed{remains}: {self._error}") from self._error

    def _close(self) -> None:
        if self._live is not None:
            self._live.close()
        if self._parts is None:
            return
        if self._error is None and self._intake.is_used:
            self._parts.end()
        else:
            self._parts.tape.close()
        self._parts.await_packed()
        if not self._intake.is_used:
            self._parts.being_written.unlink(missing_ok=True)

    def _run(self) -> None:
        try:
            self._record()
        except BaseException as error:
            self._error = error
            # The mission goes on: whoever waits for room in the queue gets it.
            while self._intake.take() is not None:
                pass

    def _record(self) -> None:
        layers: list[Layer] = [kind(self._scene) for kind in _LAYERS]
        ticks = round(self._scene.ticks_per_s * (_LIVE_FLUSH_S if self._is_live else _FLUSH_S)) or 1
        waiting: list[Observation] = []
        while (observation := self._intake.take()) is not None:
            waiting.append(observation)
            if len(waiting) == ticks:
                self._draw(layers, waiting)
                waiting = []
        if waiting:
            self._draw(layers, waiting)

    def _draw(self, layers: list[Layer], observations: list[Observation]) -> None:
        if self._parts is not None and self._parts.is_full(observations[0].tick):
            self._parts.end()
            self._parts.begin()
            for layer in layers:
                if isinstance(layer, TellsChanges):
                    layer.tell_anew()
        block, tapes = Block(self._scene, observations), self._tapes
        for layer in layers:
            for rows in layer.rows(block):
                if len(rows.block):
                    for tape in tapes:
                        tape.send(rows)
        for tape in tapes:
            tape.flush()
