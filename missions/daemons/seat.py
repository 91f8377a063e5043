"""One agent of a daemon: its side, how far it is, and what stands between the world's cues and it."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from time import monotonic

from msgspec import structs

from comms.session import Put
from comms.status import Activity, Event, Level
from missions.daemons.attended import Attended
from missions.daemons.contact import Contact
from missions.daemons.orders import Orders
from missions.daemons.wire import encode
from missions.exit_codes import DONE, FAILED
from missions.mission import Mission
from missions.sides.agent import AgentSide
from missions.sides.exchange import Cue, Done
from missions.sides.phases import PERSONS_LIMIT_S

MAX_UNTOLD = 50  # events of a time alone; the oldest go
FORGOTTEN_S = 1.0  # wall clock: without a cue for so long, the world may have given it up
LEFT_TO_PERSON = f"is to end, and a person has flown its vehicle for {PERSONS_LIMIT_S:g} s: it is left to them"


class Seat(Attended):
    """What a daemon keeps for agent `uid`, beside what people told it.

    Args:
        put: where its dones go. life: of this process. period_s: wall seconds a tick; None: in lockstep.
        orders: what it was told before it was switched on, if it was.

    Attributes:
        contact: to the world. met: the world has cued it. away: and does not any more. over: it has ended; code: with
            this exit code.
    """

    def __init__(
        self,
        side: AgentSide,
        put: Put,
        mission: Mission,
        *,
        life: int,
        period_s: float | None,
        orders: Orders | None = None,
    ) -> None:
        super().__init__(side, tick_s=mission.tick_s, orders=orders)
        self.contact = Contact(period_s=period_s, has_own_radio=bool(mission.radio.endpoints))
        self.met = False
        self.away = False
        self.over = False
        self.code = DONE
        self._life = life
        self._persons_since: int | None = None  # tick
        self._put = put
        self._mission = mission
        self._untold: deque[Event] = deque(maxlen=MAX_UNTOLD)

    @property
    def is_aloft(self) -> bool:
        """Whether it flies, and is to bring its vehicle down."""
        return not self.last.on_ground and self.activity not in (Activity.LOST, Activity.TAKEN_OVER)

    @property
    def has_ended(self) -> bool:
        """Whether there is nothing that it can still do for its vehicle."""
        return self.activity is Activity.LANDED or self.last.unheard

    def greet(self, fingerprint: str, *, world: int = 0) -> None:
        """Say hello, if the world does not cue it; `world` is the one that this process has met."""
        if (self.away or self.contact.silent_s(monotonic()) > FORGOTTEN_S) and not self.over:
            hello = structs.replace(self.side.hello(), fingerprint=fingerprint, life=self._life, world=world)
            self._put(encode(hello))

    def end(self, code: int) -> None:
        """There is nothing left to do for it."""
        self.over, self.code = True, code

    def take(self, cue: Cue) -> Sequence[Event]:
        """Do the tick of a cue from the world, and tell it; what happened without it, too. Returns what is new.

        Raises:
            RuntimeError: the inbox is not what was sent to it.
        """
        now_s = monotonic()
        if self.contact.is_stale(cue, now_s):
            return ()
        news: list[Event] = []
        for missed in self.contact.missed(self.last.tick + 1, cue):
            news += self.do(missed).status.events
        if self.away:
            news.append(Event(Level.WARNING, f"the world is back, after {self.alone_s:.1f} s without"))
        self.contact.hear(cue, now_s)
        self.met, self.away = True, False
        if cue.tick > self.last.tick:
            news += self.do(cue).status.events
            told = self.last
        else:  # it has lived through this tick alone
            told = structs.replace(self.last, tick=cue.tick, spoke=False)
        events = (*self._untold, *news)
        self._untold.clear()
        status = structs.replace(told.status, events=events)
        self._put(encode(structs.replace(told, status=status, life=self._life, world=cue.world)))
        return news

    def go_on_alone(self, now_s: float) -> Sequence[Event]:
        """Do the next tick without a cue, if the world is silent and the tick is due. Returns what is new."""
        cue = self.contact.alone(self.last.tick + 1, now_s)
        if cue is None:
            return ()
        news: list[Event] = []
        if not self.away:
            self.away = True
            limit_s = self._mission.agents.world_timeout_s
            news.append(Event(Level.WARNING, f"no word from the world: holds still, for {limit_s:g} s at most"))
        if self.is_given_up and not self.orders.come_home:
            self.orders.come_home = True
            news.append(Event(Level.ERROR, "no word from the world: flying home"))
        news += self.do(cue).status.events
        self._untold.extend(news)
        return news

    @property
    def alone_s(self) -> float:
        """How long it has done without the world, on the mission clock."""
        last = self.contact.last
        return 0.0 if last is None else (self.last.tick - last.tick) * self._mission.tick_s

    @property
    def is_given_up(self) -> bool:
        """Whether that is so long that it is to be home."""
        return self.alone_s >= self._mission.agents.world_timeout_s

    def do(self, cue: Cue) -> Done:
        """One tick of its side, under the orders of people; with that it may be over."""
        done = self.tick(cue)
        if self.orders.leave:
            done = self.last = self._leaving(done, cue.tick)
        return done

    def _leaving(self, done: Done, tick: int) -> Done:
        """It is to end: whether it can, by now."""
        status = done.status
        has_landed = done.on_ground and status.activity in (Activity.LANDED, Activity.LOST)
        if self._is_left_to_person(status.activity, tick):
            left = Event(Level.WARNING, LEFT_TO_PERSON)
            done = structs.replace(done, status=structs.replace(status, events=(*status.events, left)))
        elif not (has_landed or done.unheard):
            return done
        self.end(DONE if done.on_ground else FAILED)
        return structs.replace(done, leaves=True)

    def _is_left_to_person(self, activity: Activity, tick: int) -> bool:
        """Whether somebody else flies its vehicle, and has for so long that it will not be given back."""
        if activity is not Activity.TAKEN_OVER:
            self._persons_since = None
            return False
        if self._persons_since is None:
            self._persons_since = tick
        return (tick - self._persons_since) * self._mission.tick_s >= PERSONS_LIMIT_S
