"""`swarm agent`: one agent with its vehicle in a process of its own, or several on one session.

It says hello until the world cues it, and then does a tick for each cue. Asked to end, it flies home, lands, and goes.
Where another process is the agent already, the world does not let it in, and it goes: at once, or when it has brought
down what it flies, unless the other one flies that, too. A world that is started again is another world: who has met
the first one flies home, and ends as one that has failed, so that it is started anew for the second.
While the world is silent it holds still on its own clock (`seat`, `contact`) and says hello; after the mission's
`agents.world_timeout_s` it flies home, and so it does when the world ends.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import inf
from time import monotonic, sleep

from comms.clock import Lockstep, Pace, RealTime
from comms.credentials import agents_name
from comms.endpoint import is_local
from comms.keys import WORLD, Keys, sender
from comms.mailbox import Mailbox
from comms.radio import Radio
from comms.session import BusError, Network
from comms.status import Activity, Event, Level
from comms.transport import Transport
from missions import compose
from missions.daemons.airwaves import open_airwaves
from missions.daemons.joining import new_life, open_world, tell_of_flight, unmet
from missions.daemons.log import Log
from missions.daemons.options import DaemonOptions, await_world_s, fingerprint
from missions.daemons.orders import Orders, Verb
from missions.daemons.questions import Questions
from missions.daemons.seat import Seat
from missions.daemons.security import silence
from missions.daemons.wire import FOREIGN, OVER, TAKEN, decode_cue
from missions.ending import Ending
from missions.exit_codes import BAD_INPUT, FAILED, STOPPED
from missions.links import open_transports
from missions.mission import Mission
from missions.sides.agent import agent_sides
from missions.sides.computer import Computer
from missions.sides.exchange import Cue
from missions.sides.phases import RETURN_LIMIT_S
from missions.targets import n_targets
from missions.tlog import Tlog, failures, tlogs

HELLO_EVERY_S = 0.1
MOST_AT_ONCE = 20  # ticks that are made up for before it listens again
UNANSWERED_S = 5.0  # a world that is there and says nothing for longer may not hear us
FRAMES_LATE_S = 10.0  # frames that are under way and do not come for so long are lost
FRAME_LOOK_S = 1e-4
HOME_FIRST = "its vehicle is in the air: flying home first"
LEFT_TO_OTHER = "its vehicle is in the air, and is left to the other process"


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
                open_world(options, ending=ending, log=log, n_peers=len(mission.radio.endpoints)) as bus,
                open_airwaves(mission, uids, options, bus) as airwaves,
                tlogs(options.tlog, uids, began_unix_s=options.tlog_began_unix_s, adds=True) as logs,
            ):
                radios = compose.radios(mission, airwaves, uids, n_targets(mission))
                daemon = _Daemon(mission, radios, bus, transports, logs, options, ending=ending, log=log)
                code = daemon.run()
            for failure in failures(logs.values()):
                log.error(failure)
            return code
        except BusError as error:
            return unmet(error, mission, options, ending=ending, log=log)
        except KeyboardInterrupt:
            log.error("ended at once, in the air or not")
    return STOPPED if ending.interrupted else FAILED


class _Daemon:
    def __init__(
        self,
        mission: Mission,
        radios: Sequence[Radio],
        bus: Network,
        transports: dict[int, Transport],
        logs: Mapping[int, Tlog],
        options: DaemonOptions,
        *,
        ending: Ending,
        log: Log,
    ) -> None:
        self._mission = mission
        self._bus = bus
        self._transports = transports
        self._logs = logs
        self._options = options
        self._ending = ending
        self._log = log
        self._keys = Keys(mission.name)
        self._radios = {radio.uid: radio for radio in radios}
        self._mail = Mailbox(self._radios)
        self._questions: Questions[int] = Questions()
        self._fingerprint = fingerprint(mission, options.speed)
        self._life = new_life()
        self._greeted_at_s = -inf
        self._world = 0  # the life of the one that it has met
        self._gone_at_s: float | None = None  # the world
        self._came_at_s: float | None = None  # and is there
        self._is_unanswered = True  # and has not said so
        self._is_closing = False
        self._hide: dict[int, Callable[[], None]] = {}  # takes back that an agent is there
        self._puts = {uid: bus.publisher(self._keys.done(uid)) for uid in self._radios}
        self._seats = {uid: self._seat(uid, started_tick=0, orders=Orders()) for uid in self._radios}

    def run(self) -> int:
        """Tick until everybody here is over; the exit code."""
        bus, keys = self._bus, self._keys
        for uid in self._seats:
            bus.subscribe(keys.cue(uid), lambda key, payload: self._mail.put(sender(key), payload))
            self._hide[uid] = bus.declare_alive(keys.alive(uid))
            self._questions.take_at(bus, keys.every_command(uid), uid)
        bus.watch(keys.alive(WORLD), self._on_world)
        tell_of_flight(bus, keys, self._log)
        self._log.info("ready")
        deadline_s = monotonic() + self._options.join_s
        while self._flying():
            self._greet()
            self._mail.wait(self._awaited(), timeout_s=self._patience_s())
            self._questions.answer(lambda uid, word: self._seats[uid].obey(word))
            for uid, wires in self._mail.take().items():
                self._take(self._seats[uid], wires)
            if not any(seat.met for seat in self._seats.values()):
                if self._ending.asked:
                    break
                if (came_at_s := self._came_at_s) is not None:  # the world, and it waits for others
                    deadline_s = monotonic() + self._options.join_s
                    self._tell_if_unanswered(monotonic() - came_at_s)
                if monotonic() > deadline_s:
                    hint = silence(self._options.credentials)
                    self._log.error(
                        f"no word from the world of {self._mission.name} for {self._options.join_s:g} s{hint}"
                    )
                    return FAILED
            elif self._is_closing or self._is_world_lost():
                self._end_with_world()
            else:
                self._go_on_alone()
        return STOPPED if self._ending.interrupted else max(seat.code for seat in self._seats.values())

    def _flying(self) -> list[Seat]:
        return [seat for seat in self._seats.values() if not seat.over]

    def _awaited(self) -> list[int]:
        """Whose cues come; all are there for who has not been cued yet."""
        flying = self._flying()
        return [seat.uid for seat in flying if not seat.away] or [seat.uid for seat in flying]

    def _patience_s(self) -> float:
        """Until there is something to do without a cue."""
        due_s = min(seat.contact.due_s(seat.last.tick + 1) for seat in self._flying())
        return min(HELLO_EVERY_S, max(0.0, due_s - monotonic()))

    def _seat(self, uid: int, *, started_tick: int, orders: Orders) -> Seat:
        [side] = agent_sides(
            self._mission,
            [self._radios[uid]],
            n_targets=n_targets(self._mission),
            transports=self._transports,
            started_tick=started_tick,
        )
        if uid in self._logs:
            side.tap = self._logs[uid].pass_on
        period_s = None if self._options.lockstep else self._mission.tick_s / self._options.speed
        return Seat(side, self._puts[uid], self._mission, life=self._life, period_s=period_s, orders=orders)

    def _greet(self) -> None:
        now_s = monotonic()
        if self._gone_at_s is None and now_s - self._greeted_at_s >= HELLO_EVERY_S:
            self._greeted_at_s = now_s
            for seat in self._seats.values():
                seat.greet(self._fingerprint, world=self._world)

    def _tell_if_unanswered(self, there_s: float) -> None:
        """The world may wait for others, and says nothing meanwhile; but so it is, too, where it does not hear us."""
        credentials = self._options.credentials
        if self._is_unanswered and credentials is not None and there_s > UNANSWERED_S:
            self._is_unanswered = False
            text = f"the world of {self._mission.name} is there, and has not answered our hello: it may wait for others"
            self._log.say(Level.WARNING, text + silence(credentials))

    def _take(self, seat: Seat, wires: Iterable[bytes]) -> None:
        """What has come from the world: of cues the newest one counts."""
        newest = None
        for wire in wires:
            if wire == OVER:
                self._is_closing = self._is_closing or seat.is_aloft
                seat.over = not seat.is_aloft
                return
            cue = decode_cue(wire)
            if cue is None or cue.life != self._life:
                continue
            if cue.refused or self._world in (0, cue.world):
                newest = cue
        if newest is None or seat.over:  # it may have come down with another one
            return
        self._is_unanswered = False
        if newest.refused:
            self._turn_away(seat, newest.refused)
        else:
            self._world = newest.world
            self._heed(seat, newest)

    def _turn_away(self, seat: Seat, why: str) -> None:
        """The world does not let this process in, and never will."""
        who = agents_name([seat.uid])
        self._log.say(Level.ERROR, why, who=who)
        self._hide[seat.uid]()  # or nobody would notice the death of the one that is there
        aloft = [other for other in self._flying() if other.is_aloft]
        code = FAILED if why == FOREIGN else BAD_INPUT  # started anew it is let in
        if why == TAKEN:
            seat.side.tap = None  # the other one keeps the log
            aloft = [seat] if seat.is_aloft else []
        if aloft and why == TAKEN and seat.uid in self._transports:
            self._log.say(Level.ERROR, LEFT_TO_OTHER, who=who)
        elif aloft:
            self._log.say(Level.ERROR, HOME_FIRST, who=who)
            self._fly_home(aloft, code=code)
        seat.end(code)

    def _heed(self, seat: Seat, cue: Cue) -> None:
        """Do the tick of a cue."""
        if not seat.met and cue.tick > 0:
            # It comes back to a mission that is under way: its vehicle is switched on now, and obeys what it was told.
            seat = self._seats[seat.uid] = self._seat(seat.uid, started_tick=cue.tick, orders=seat.orders)
        self._await_frames(seat.side.computer, cue)
        self._obey(seat)
        self._say(seat, seat.take(cue))

    def _go_on_alone(self) -> None:
        """Whoever hears nothing of the world does what is due, and is over once it has flown home."""
        now_s = monotonic()
        for seat in self._flying():
            if not seat.met:
                continue
            for _ in range(MOST_AT_ONCE):
                before = seat.last
                self._obey(seat)
                self._say(seat, seat.go_on_alone(now_s))
                if seat.last is before:
                    break
            if seat.is_given_up and seat.has_ended:
                seat.end(FAILED)

    def _obey(self, seat: Seat) -> None:
        if self._ending.asked:
            seat.orders.take(Verb.STOP, seat.activity)

    def _say(self, seat: Seat, events: Iterable[Event]) -> None:
        self._log.time_s = seat.last.tick * self._mission.tick_s
        self._log.events(events, who=agents_name([seat.uid]))

    def _await_frames(self, computer: Computer, cue: Cue) -> None:
        due, deadline_s, now_s = computer.due(cue), monotonic() + FRAMES_LATE_S, cue.tick * self._mission.tick_s
        while due is not None and computer.radio.waiting(now_s) < due and monotonic() < deadline_s:
            sleep(FRAME_LOOK_S)

    def _on_world(self, key: str, is_there: bool) -> None:
        now_s = monotonic()
        self._gone_at_s, self._came_at_s = (None, now_s) if is_there else (now_s, None)
        self._greeted_at_s = -inf
        self._mail.wake()

    def _is_world_lost(self) -> bool:
        """Whether the world's process has gone, and is not waited for any longer.

        In lockstep time stands still meanwhile; where the agents' own clock goes on, they know themselves how long.
        """
        gone_at_s, lockstep = self._gone_at_s, self._options.lockstep
        if gone_at_s is None:
            return False
        for seat in self._flying():
            seat.away = seat.away or lockstep
        is_awaited = lockstep or is_local(self._options.endpoint)
        return is_awaited and monotonic() - gone_at_s > await_world_s(self._mission, self._options)

    def _end_with_world(self) -> None:
        """The world has ended: who is still up comes down by itself."""
        for seat in self._flying():
            seat.over = seat.activity is Activity.LANDED
        if flying := self._flying():
            self._log.error("the world has gone: flying home")
            self._fly_home(flying, code=FAILED)

    def _fly_home(self, seats: Sequence[Seat], *, code: int) -> None:
        """Bring these down, whom nobody tells the time any more; they end with that code."""
        tick_s = self._mission.tick_s
        linked = any(seat.uid in self._transports for seat in seats)
        pace: Pace = RealTime(tick_s=tick_s, speed=1.0) if linked else Lockstep()
        first = max((seat.last.tick for seat in seats), default=0) + 1
        for tick in range(first, first + round(RETURN_LIMIT_S / tick_s)):
            flying = [seat for seat in seats if not seat.over]
            if not flying:
                break
            pace.begin(tick)
            for seat in flying:
                seat.orders.take(Verb.STOP, seat.activity)
                self._say(seat, seat.do(seat.contact.come_home(tick)).status.events)
                if seat.over or seat.has_ended:
                    seat.end(code)
        for seat in seats:
            seat.end(code)
