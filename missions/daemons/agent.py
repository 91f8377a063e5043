"""`swarm agent`: one agent with its vehicle in a process of its own, or several on one session.

It says hello until the world cues it, and then does a tick for each cue. Asked to end, it flies home, lands, and goes.
If the world goes first, it flies home on its own clock.
"""

from __future__ import annotations

import queue
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from time import monotonic, sleep

from msgspec import structs

from comms.clock import Lockstep, Pace, RealTime
from comms.credentials import agents_name
from comms.keys import WORLD, Keys, sender, verb_of
from comms.mailbox import Mailbox
from comms.radio import Radio
from comms.session import BusError, Network, Put, Question, open_client
from comms.status import Activity
from comms.transport import Transport
from missions import compose
from missions.daemons.airwaves import open_airwaves
from missions.daemons.ending import Ending
from missions.daemons.log import Log
from missions.daemons.options import DaemonOptions, fingerprint
from missions.daemons.orders import Answer, Orders, Verb, Watch, encode_answer
from missions.daemons.security import silence, why
from missions.daemons.wire import OVER, decode_cue, encode
from missions.links import open_transports
from missions.mission import Mission
from missions.sides.agent import AgentSide, agent_sides
from missions.sides.computer import Computer
from missions.sides.exchange import Cue, Done
from missions.sides.phases import RETURN_LIMIT_S
from missions.targets import n_targets

DONE, FAILED, STOPPED = 0, 1, 130

HELLO_EVERY_S = 0.2
FRAMES_LATE_S = 10.0  # frames that are under way and do not come for so long are lost
FRAME_LOOK_S = 1e-4
MAX_QUESTIONS = 100


def agent(mission: Mission, uids: Sequence[int], options: DaemonOptions) -> int:
    """Run these agents of a mission until it is over. Returns the exit code.

    Raises:
        InputError: a link to a vehicle that cannot be opened.
    """
    log = Log(agents_name(uids), least=options.log_level)
    ending = Ending(log.info)
    with ending.listening(leash=options.leash), open_transports(mission, uids) as transports:
        try:
            with (
                open_client(
                    options.endpoint,
                    lossless=options.lockstep,
                    patience_s=options.join_s,
                    credentials=options.credentials,
                ) as bus,
                open_airwaves(mission, uids, options, bus) as airwaves,
            ):
                radios = compose.radios(mission, airwaves, uids, n_targets(mission))
                daemon = _Daemon(mission, radios, bus, transports, options, ending=ending, log=log)
                return daemon.run()
        except BusError as error:
            hint = f"does `swarm world {mission.name}` run there?"
            log.error(why(error, options.credentials, otherwise=hint))
        except KeyboardInterrupt:
            log.error("ended at once, in the air or not")
    return STOPPED if ending.interrupted else FAILED


@dataclass(slots=True)
class _Seat:
    """One agent of this process: its side, where its dones go, and how far it is."""

    side: AgentSide
    put: Put
    last: Done
    orders: Orders = field(default_factory=Orders)
    watch: Watch = field(default_factory=Watch)
    met: bool = False  # the world has cued it
    over: bool = False


class _Daemon:
    def __init__(
        self,
        mission: Mission,
        radios: Sequence[Radio],
        bus: Network,
        transports: dict[int, Transport],
        options: DaemonOptions,
        *,
        ending: Ending,
        log: Log,
    ) -> None:
        self._mission = mission
        self._bus = bus
        self._transports = transports
        self._options = options
        self._ending = ending
        self._log = log
        self._keys = Keys(mission.name)
        self._radios = {radio.uid: radio for radio in radios}
        self._mail = Mailbox(self._radios)
        self._questions: queue.Queue[tuple[int, Question]] = queue.Queue(MAX_QUESTIONS)
        self._world_gone = False
        self._seats = {uid: self._seat(uid, started_tick=0) for uid in self._radios}

    def run(self) -> int:
        """Tick until everybody here is over; the exit code."""
        bus, keys, join_s = self._bus, self._keys, self._options.join_s
        for uid in self._seats:
            bus.subscribe(keys.cue(uid), lambda key, payload: self._mail.put(sender(key), payload))
            bus.declare_alive(keys.alive(uid))
            bus.answer(keys.every_command(uid), partial(self._ask, uid))
        bus.watch(keys.alive(WORLD), self._on_world)
        self._log.info("ready")
        deadline_s = monotonic() + join_s
        while self._flying():
            self._greet()
            self._mail.wait(self._flying(), timeout_s=HELLO_EVERY_S)
            self._answer()
            for uid, wire in self._mail.take().items():
                self._take(self._seats[uid], wire)
            if not any(seat.met for seat in self._seats.values()):
                if self._ending.asked:
                    return self._code(DONE)
                if monotonic() > deadline_s:
                    hint = silence(self._options.credentials)
                    self._log.error(f"no word from the world of {self._mission.name} for {join_s:g} s{hint}")
                    return FAILED
            elif self._world_gone and self._flying():
                return self._fly_home()
        return self._code(DONE)

    def _flying(self) -> list[int]:
        return [uid for uid, seat in self._seats.items() if not seat.over]

    def _code(self, code: int) -> int:
        return STOPPED if self._ending.interrupted else code

    def _seat(self, uid: int, *, started_tick: int) -> _Seat:
        [side] = agent_sides(
            self._mission,
            [self._radios[uid]],
            n_targets=n_targets(self._mission),
            transports=self._transports,
            started_tick=started_tick,
        )
        return _Seat(side, self._bus.publisher(self._keys.done(uid)), side.hello())

    def _greet(self) -> None:
        for seat in self._seats.values():
            if not (seat.met or seat.over):
                seat.put(encode(structs.replace(seat.side.hello(), fingerprint=fingerprint(self._mission))))

    def _take(self, seat: _Seat, wire: bytes) -> None:
        """One message from the world."""
        if wire == OVER:
            seat.over = True
            return
        cue = decode_cue(wire)
        if cue is None:
            return
        if not seat.met:
            if cue.tick > 0:  # it comes back to a mission that is under way: its vehicle is switched on now
                seat = self._seats[seat.side.uid] = self._seat(seat.side.uid, started_tick=cue.tick)
            seat.met = True
        self._await_frames(seat.side.computer, cue)
        self._tick(seat, cue)

    def _tick(self, seat: _Seat, cue: Cue) -> None:
        began_s, time_s = monotonic(), cue.tick * self._mission.tick_s
        self._log.time_s = time_s
        if self._ending.asked:
            seat.orders.take(Verb.STOP, seat.last.status.activity)
        done = seat.side.tick(seat.orders.amend(cue))
        seat.watch.see(done, time_s=time_s, late_s=cue.late_s, busy_s=monotonic() - began_s)
        if seat.orders.leave and done.status.activity is Activity.LANDED:
            done = structs.replace(done, leaves=True)
            seat.over = True
        seat.last = done
        seat.put(encode(done))
        self._log.events(done.status.events, who=agents_name([seat.side.uid]))

    def _ask(self, uid: int, question: Question) -> None:
        with suppress(queue.Full):  # whoever asks so often gets no answer, and asks again
            self._questions.put_nowait((uid, question))

    def _answer(self) -> None:
        """What people have told us since the last tick."""
        while not self._questions.empty():
            uid, question = self._questions.get_nowait()
            seat = self._seats[uid]
            obeyed, text = seat.orders.take(verb_of(question.key), seat.last.status.activity)
            report = seat.watch.report(seat.last, time_s=self._log.time_s)
            question.answer(encode_answer(Answer(obeyed=obeyed, text=text, report=report)))

    def _await_frames(self, computer: Computer, cue: Cue) -> None:
        due, deadline_s, now_s = computer.due(cue), monotonic() + FRAMES_LATE_S, cue.tick * self._mission.tick_s
        while due is not None and computer.radio.waiting(now_s) < due and monotonic() < deadline_s:
            sleep(FRAME_LOOK_S)

    def _on_world(self, key: str, is_there: bool) -> None:
        self._world_gone = not is_there
        if not is_there:
            for uid in self._seats:
                self._mail.give_up(uid)

    def _fly_home(self) -> int:
        """The world has gone, and with it the clock: who is still up comes down by itself."""
        for seat in self._seats.values():
            seat.over = seat.over or seat.last.status.activity is Activity.LANDED
        if not self._flying():
            return self._code(DONE)
        self._log.error("the world has gone: flying home")
        tick_s = self._mission.tick_s
        pace: Pace = RealTime(tick_s=tick_s, speed=1.0) if self._transports else Lockstep()
        first = max(seat.last.tick for seat in self._seats.values()) + 1
        for tick in range(first, first + round(RETURN_LIMIT_S / tick_s)):
            pace.begin(tick)
            for uid in self._flying():
                seat = self._seats[uid]
                self._tick(seat, Cue(tick=tick, come_home=True, frames=None))
                seat.over = seat.over or seat.last.status.activity is Activity.LANDED or seat.last.unheard
            if not self._flying():
                break
        return self._code(FAILED)
