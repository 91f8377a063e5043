"""The recorder in a process of its own, as the world sees it: every observation goes there, and none piles up."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from time import monotonic

import msgspec

from comms.keys import Keys
from comms.session import Network
from comms.status import Event, Level
from missions.daemons.crew import CrewError
from missions.daemons.wire import OVER, STRANGE, encode
from missions.observation import Observation

WINDOW_TICKS = 100  # lockstep lets the recorder fall behind so far, and then waits for it
LOST_S = 30.0  # a recorder that does not get on for so long is lost
KEPT_EVERY_TICKS = 10
LOOK_S = 0.2
UNAWAITED = "asked to end before the recording was finished"


def _never() -> bool:
    """Nobody stops it."""
    return False


class Kept(msgspec.Struct, frozen=True):
    """The recorder to the world: ticks up to this one are kept (-1: it is there), in that file; or why it failed.

    recording: the first file, which has another name until it is whole. closed: all is whole, but for the ticks that
    were dropped. fingerprint: of the mission that it was given.
    life: of the recorder's process.
    """

    tick: int
    recording: str | None = None
    failure: str = ""
    closed: bool = False
    dropped: int = 0
    fingerprint: str = ""
    life: int = 0


class Feed:
    """An observer that passes observations on to a recorder, if there is one. Others look on: nobody waits for them.

    Args:
        fingerprint: of the mission; a recorder of another one gets nothing.
        back_s: how long a recorder that has gone may still be back, if it was its link that was cut.
        begin: called when it comes, from another thread. tell: what becomes of it.

    Attributes:
        recording: the recorder's file. failures: why not everything was kept that was to be kept.
    """

    def __init__(
        self,
        bus: Network,
        *,
        keys: Keys,
        lockstep: bool,
        fingerprint: str,
        back_s: float,
        begin: Callable[[], None],
        tell: Callable[[Event], None],
    ) -> None:
        self.failures: list[str] = []
        self._keys = keys
        self._put = bus.publisher(keys.truth)
        self._lockstep = lockstep
        self._fingerprint = fingerprint
        self._back_s = back_s
        self._begin = begin
        self._tell = tell
        self._is_strange = False
        self._kept: Kept | None = None
        self._first: int | None = None  # the tick at which it came: it may come late
        self._progress = threading.Condition()
        self._there = False
        self._gone_at_s = 0.0
        bus.subscribe(keys.kept, self._hear)
        bus.watch(keys.every_recorder, self._on_change)

    @property
    def recording(self) -> Path | None:
        """Where the recorder kept it, when it was heard last."""
        kept = self._kept
        return Path(kept.recording) if kept is not None and kept.recording is not None else None

    def await_recorder(self, timeout_s: float, *, stop: Callable[[], bool]) -> None:
        """Until it is there.

        Raises:
            CrewError: it does not come, or `stop` says that it is not to be waited for.
        """
        if not self._wait(lambda kept: True, timeout_s, stop):
            if stop():
                raise CrewError("asked to end before the recorder was there")
            raise CrewError(f"no sign of the recorder for {timeout_s:g} s")

    def observe(self, observation: Observation) -> None:
        """Pass it on; in lockstep wait for a recorder that is behind."""
        if self._kept is None or self._kept.closed or self.failures:
            return
        if self._kept.failure or self._is_gone():
            self._fail(f"the recorder has gone: nothing is recorded from {observation.time_s:.1f} s")
            return
        if self._first is None:
            self._first = observation.tick
        self._put(encode(observation))
        if self._lockstep:
            due = observation.tick - WINDOW_TICKS
            behind = due >= self._first and self._kept.tick < due
            if behind and not self._wait(lambda kept: kept.tick >= due or kept.closed, LOST_S):
                self._fail(f"the recorder does not get on: nothing is recorded from {observation.time_s:.1f} s")

    def close(self, *, stop: Callable[[], bool]) -> None:
        """The mission is over: wait until its recording is whole, unless that is to stop."""
        self._put(OVER)
        if self._kept is None or self.failures:
            return
        if not self._wait(lambda kept: kept.closed, LOST_S, stop):
            self._fail(UNAWAITED if stop() else "the recording was not finished")
        elif self._kept.dropped:
            self._fail(f"the recorder was too slow, or its link was cut: {self._kept.dropped} ticks are missing")

    def _wait(self, enough: Callable[[Kept], bool], timeout_s: float, stop: Callable[[], bool] = _never) -> bool:
        deadline_s = monotonic() + timeout_s
        with self._progress:
            while self._kept is None or not enough(self._kept):
                left_s = deadline_s - monotonic()
                lost = self._kept is not None and self._is_gone()
                if left_s <= 0.0 or lost or (self._kept is not None and self._kept.failure) or stop():
                    return False
                self._progress.wait(min(left_s, LOOK_S))
        return True

    def _is_gone(self) -> bool:
        """Whether it is not there, and has not been for so long that it will not be back."""
        return not self._there and monotonic() - self._gone_at_s >= self._back_s

    def _fail(self, why: str) -> None:
        kept = self._kept
        self.failures.append(kept.failure if kept is not None and kept.failure else why)
        self._tell(Event(Level.ERROR, self.failures[-1]))

    def _hear(self, key: str, payload: bytes) -> None:
        try:
            kept = msgspec.msgpack.decode(payload, type=Kept)
        except (msgspec.DecodeError, UnicodeDecodeError):
            return
        if self._kept is None and kept.fingerprint != self._fingerprint:
            if not self._is_strange:
                self._is_strange = True
                self._tell(Event(Level.ERROR, STRANGE))
            return
        if self._kept is not None and kept.life != self._kept.life:
            return
        with self._progress:
            if self._kept is None:
                self._begin()
            self._kept = kept
            self._there = True
            self._progress.notify_all()

    def _on_change(self, key: str, is_there: bool) -> None:
        with self._progress:
            if self._kept is None or key != self._keys.recorder(self._kept.life):
                return  # an onlooker's, or of one that has not said yet what it is
            if self._there and not is_there:
                self._gone_at_s = monotonic()
            self._there = is_there
            self._progress.notify_all()
