"""`swarm record`: the recorder in a process of its own, on the observer channel of a mission's world."""

from __future__ import annotations

import queue
import sys
from contextlib import suppress
from time import monotonic
from typing import TYPE_CHECKING

import msgspec
from msgspec import structs

from comms.keys import WORLD, Keys
from comms.radio import Roster
from comms.session import BusError, Network
from missions.daemons.feed import KEPT_EVERY_TICKS, WINDOW_TICKS, Kept
from missions.daemons.joining import new_life, open_world, tell_of_flight, unmet
from missions.daemons.log import Log
from missions.daemons.options import DaemonOptions, await_world_s, fingerprint
from missions.daemons.security import silence
from missions.daemons.wire import OVER, decode_observation
from missions.ending import Ending
from missions.exit_codes import DONE, FAILED, STOPPED
from missions.launch import recorder_of
from missions.mission import Mission
from missions.options import LaunchOptions
from missions.problems import InputError, OutputError
from missions.sides.exchange import HELLO_TICK
from missions.targets import n_targets

if TYPE_CHECKING:
    from missions.recording import Recorder

HELLO_EVERY_S = 0.2


def record(mission: Mission, daemon: DaemonOptions, options: LaunchOptions) -> int:
    """Record a mission until it is over. Returns the exit code.

    Raises:
        InputError: this installation cannot record, or the file cannot be written.
    """
    log = Log("recorder", least=daemon.log_level)
    ending = Ending(log.info)
    with ending.listening(leash=daemon.leash):
        roster = Roster(mission.agents.count, n_targets(mission))
        recorder = recorder_of(mission, roster.n_targets, options)
        try:
            recorder.__enter__()
        except OutputError as error:
            raise InputError(str(error)) from error
        if recorder.page_url is not None:
            sys.stderr.write(f"Watch it in a browser: {recorder.page_url}\n")
        try:
            with open_world(daemon, ending=ending, log=log) as bus:
                return _Reel(mission, roster, bus, recorder, daemon, ending=ending, log=log).run()
        except BusError as error:
            recorder.__exit__(type(error), error, None)
            return unmet(error, mission, daemon, ending=ending, log=log)
        except KeyboardInterrupt:
            log.error(f"ended at once{_remains(recorder)}")
    return STOPPED if ending.interrupted else FAILED


def _remains(recorder: Recorder) -> str:
    """What one who does not wait for the end of a file should know."""
    part = recorder.being_written
    return "" if part is None or not part.is_file() else f": {part} is not finished; swarm review repairs it to be read"


class _Reel:
    """Observations from the bus to a recorder that is open."""

    def __init__(
        self,
        mission: Mission,
        roster: Roster,
        bus: Network,
        recorder: Recorder,
        daemon: DaemonOptions,
        *,
        ending: Ending,
        log: Log,
    ) -> None:
        keys = Keys(mission.name)
        self._recorder = recorder
        self._fingerprint = fingerprint(mission, daemon.speed)
        self._life = new_life()
        self._daemon = daemon
        self._ending = ending
        self._log = log
        # What comes too fast in real time is dropped, as in the recorder's own queue.
        self._inbox: queue.Queue[bytes] = queue.Queue(4 * WINDOW_TICKS)
        self._roster = roster
        self._last_tick: int | None = None
        self._missing = 0
        self._over = False
        self._await_world_s = await_world_s(mission, daemon)
        self._gone_at_s: float | None = None
        self._put = bus.publisher(keys.kept)
        bus.subscribe(keys.truth, self._hear)
        bus.watch(keys.alive(WORLD), self._on_world)
        bus.declare_alive(keys.recorder(self._life))
        tell_of_flight(bus, keys, log)

    def run(self) -> int:
        """Record until the mission is over."""
        code = self._record()
        try:
            self._recorder.__exit__(None, None, None)
        except OutputError as error:
            self._log.error(str(error))
            self._tell(Kept(HELLO_TICK, failure=str(error)))
            return FAILED
        dropped = self._missing + self._recorder.dropped
        if dropped:
            self._log.error(f"the recorder was too slow, or its link was cut: {dropped} ticks are missing")
            code = code or FAILED
        self._tell(Kept(HELLO_TICK, recording=self._path, closed=True, dropped=dropped))
        return code

    def _record(self) -> int:
        deadline_s = monotonic() + self._daemon.join_s
        while not self._ending.asked:
            try:
                wire = self._inbox.get(timeout=HELLO_EVERY_S)
            except queue.Empty:
                if self._over:
                    return DONE
                gone_at_s = self._gone_at_s
                if gone_at_s is not None and monotonic() - gone_at_s > self._await_world_s:
                    self._log.error("the world has gone: the recording ends here")
                    return FAILED
                if self._last_tick is None:
                    if monotonic() > deadline_s:
                        hint = silence(self._daemon.credentials)
                        self._log.error(f"no word from the world for {self._daemon.join_s:g} s{hint}")
                        return FAILED
                    self._tell(Kept(HELLO_TICK, recording=self._path, fingerprint=self._fingerprint))
                continue
            observation = decode_observation(wire, self._roster)
            if observation is None:
                self._log.error(f"an observation of {len(wire)} bytes cannot be read")
                continue
            if self._last_tick is not None:
                self._missing += max(0, observation.tick - self._last_tick - 1)
            self._last_tick = observation.tick
            self._recorder.observe(observation)
            if self._recorder.has_failed:
                return FAILED
            if observation.tick % KEPT_EVERY_TICKS == 0:
                self._tell(Kept(observation.tick, recording=self._path))
        return STOPPED if self._ending.interrupted else DONE

    @property
    def _path(self) -> str | None:
        """The recording's first file, which is unfinished as long as it is written."""
        from missions.recording.names import begins_in

        return None if self._recorder.path is None else str(begins_in(self._recorder.path))

    def _tell(self, kept: Kept) -> None:
        self._put(msgspec.msgpack.encode(structs.replace(kept, life=self._life)))

    def _hear(self, key: str, payload: bytes) -> None:
        if payload == OVER:  # there is always room for that
            self._over = True
            return
        with suppress(queue.Full):
            self._inbox.put_nowait(payload)

    def _on_world(self, key: str, is_there: bool) -> None:
        self._gone_at_s = None if is_there else monotonic()
