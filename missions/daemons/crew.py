"""The agents of a mission in processes of their own, as the world sees them: the barrier of each tick.

A tick is published as one cue an agent; it is over when every agent's done is there. An agent that does not answer in
time, or whose process is seen to die, is lost: that is told, and nobody waits for it until it says hello again
(`member`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import monotonic, sleep

from msgspec import structs

from comms.clock import Awake
from comms.keys import Keys, sender
from comms.mailbox import Mailbox
from comms.radio import Roster
from comms.session import Network
from comms.status import Activity, Event, Level
from missions.daemons.joining import new_life
from missions.daemons.member import Member
from missions.daemons.wire import FOREIGN, OVER, STRANGE, TAKEN, UNRELIABLE, decode_done, encode
from missions.sides.exchange import HELLO_TICK, Cue, Done
from missions.sides.medium import Medium

LOOK_S = 0.2
AWAKE_S = 1.0  # between two looks of ours; what is more, we have stood still ourselves
FRAME_LOOK_S = 1e-4
MOST_IN_VAIN = 3  # so often one agent may hold up all others for as long as it takes to lose it
BACK = "its process is back"
DIED = "its process has died, or its link is cut"
UNHEARD = "has sent a frame, as it says, and none has come: lost"
LEFT_IN_AIR = "its process has left, and its vehicle is in the air"


@dataclass(frozen=True, slots=True, kw_only=True)
class Patience:
    """How long the world waits, on the wall clock: for everybody's hello, for a tick's dones, and until one is lost.

    In lockstep a done that does not come in `tick_s` is lost with its agent. In real time the tick goes on without it,
    and `lost_s` decides. Who is lost may be back for `back_s`, if it was the link that was cut: so long the mission is
    not over for it.
    """

    join_s: float
    tick_s: float
    lost_s: float
    back_s: float
    lockstep: bool


class CrewError(Exception):
    """Not everybody came."""


class RemoteCrew:
    """Agents behind a bus, by uid. See `missions.sides.world.Crew`.

    Args:
        roster: whom the mission has.
        fingerprint: of the mission; agents of another one are not let in. tell: what becomes of which agent.
        stop: once true, nobody is waited for who has not come yet.

    Attributes:
        lost: every agent that was lost at some time.
    """

    def __init__(
        self,
        bus: Network,
        *,
        keys: Keys,
        roster: Roster,
        medium: Medium,
        patience: Patience,
        fingerprint: str,
        tell: Callable[[int, Event], None],
        stop: Callable[[], bool],
    ) -> None:
        self.lost: set[int] = set()
        self._medium = medium
        self._patience = patience
        self._fingerprint = fingerprint
        self._world = new_life()  # a world that is started again is another one
        self._tell = tell
        self._stop = stop
        self._roster = roster
        self._members = [Member(uid) for uid in range(roster.n_agents)]
        self._mail = Mailbox(range(roster.n_agents))
        self._puts = [bus.publisher(keys.cue(uid)) for uid in range(roster.n_agents)]
        self._awake = Awake(most_s=AWAKE_S)
        self._dead: set[int] = set()  # seen to die, from another thread
        self._refused: set[tuple[int, str]] = set()  # who, and why: told once
        self._tick = HELLO_TICK  # under way
        bus.subscribe(keys.every_done, lambda key, payload: self._mail.put(sender(key), payload))
        bus.watch(keys.every_alive, self._on_change)

    def hello(self) -> list[Done]:
        """Wait until everybody is there.

        Raises:
            CrewError: somebody is not, in time.
        """
        deadline_s = monotonic() + self._patience.join_s
        while missing := [member.uid for member in self._members if not member.is_there]:
            if self._stop():
                raise CrewError("asked to end before everybody was there")
            if monotonic() > deadline_s:
                raise CrewError(f"no sign of agent {', '.join(map(str, missing))} for {self._patience.join_s:g} s")
            self._mail.wait(missing, timeout_s=LOOK_S)
            self._collect()
        self.lost.clear()
        for member in self._members:
            member.is_new = False
            member.news.clear()
        return [member.last for member in self._members]

    def tick(self, cues: Sequence[Cue]) -> list[Done]:
        """Let everybody who is there do its tick; who is not is LOST, where it was last."""
        self._collect()
        if self._patience.lockstep:
            self._await_anybody()
        tick = self._tick = cues[0].tick
        waiting = [member for member in self._members if member.is_there]
        for member in waiting:
            self._cue(member, cues[member.uid])
        deadline_s = self._awake.now_s() + self._patience.tick_s
        while waiting and (left_s := deadline_s - self._awake.now_s()) > 0.0:
            self._mail.wait([member.uid for member in waiting], timeout_s=min(LOOK_S, left_s))
            self._collect()
            waiting = [member for member in waiting if member.owes(tick)]
        for member in waiting:
            silent_s = self._awake.now_s() - member.heard_at_s
            if self._patience.lockstep or silent_s > self._patience.lost_s:
                self._lose(member, f"no answer for {silent_s:.0f} s: lost", was_awaited=self._patience.lockstep)
        if self._patience.lockstep:
            self._await_frames([member.uid for member in self._members if member.has_spoken(tick)])
        return [member.tell(tick, may_be_back=self._may_be_back(member)) for member in self._members]

    def dismiss(self) -> None:
        """The mission is over: everybody may go."""
        for put in self._puts:
            put(OVER)

    def _cue(self, member: Member, cue: Cue) -> None:
        # The radio of one that is new has not been waiting for what is under way.
        unchecked = member.is_new or not self._patience.lockstep
        frames = None if unchecked else cue.frames
        self._puts[member.uid](encode(structs.replace(cue, frames=frames, life=member.life, world=self._world)))
        member.is_new = False

    def _collect(self) -> None:
        """Take in what has come, and who has died."""
        for uid, wires in self._mail.take().items():
            for wire in wires:
                done = decode_done(wire, uid, self._roster)
                if done is not None:
                    self._hear(self._members[uid], done)
        while self._dead:
            uid = self._dead.pop()
            if uid < len(self._members) and self._members[uid].is_there:
                self._lose(self._members[uid], DIED)

    def _hear(self, member: Member, done: Done) -> None:
        now_s = self._awake.now_s()
        if done.tick == HELLO_TICK:
            self._greet(member, done, now_s)
        elif done.tick <= self._tick:  # or it is of a tick that has not begun
            was_there = member.is_there
            member.hear(done, now_s)
            has_left = was_there and not member.is_there
            if has_left and not done.on_ground and done.status.activity is not Activity.LOST:
                self._lose(member, LEFT_IN_AIR)

    def _greet(self, member: Member, hello: Done, now_s: float) -> None:
        """A process says that it is there, and is let in, or told why not, or has to wait."""
        if hello.fingerprint != self._fingerprint:
            self._refuse(member.uid, hello.life, STRANGE)
        elif member.awaited_in_vain >= MOST_IN_VAIN:
            self._refuse(member.uid, hello.life, UNRELIABLE)
        elif member.is_rival_in_vain(hello.life):
            self._refuse(member.uid, hello.life, TAKEN)
        elif hello.world not in (0, self._world) and not member.is_there:
            # Our ticks are of the past to it. Where another process is there, that one may fly the vehicle: see TAKEN.
            self._refuse(member.uid, hello.life, FOREIGN)
        else:
            has_come = member.done is not None
            if member.greet(hello, now_s) and has_come:
                self._say(member, Event(Level.WARNING, BACK))

    def _refuse(self, uid: int, life: int, why: str) -> None:
        self._puts[uid](encode(Cue(tick=self._tick, life=life, refused=why, world=self._world)))
        if (uid, why) not in self._refused:
            self._refused.add((uid, why))
            self._tell(uid, Event(Level.ERROR, why))

    def _lose(self, member: Member, why: str, *, was_awaited: bool = False) -> None:
        member.awaited_in_vain += was_awaited
        self.lost.add(member.uid)
        self._say(member, Event(Level.ERROR, why))
        member.lose(self._awake.now_s())

    def _say(self, member: Member, event: Event) -> None:
        """To whoever watches, and with the agent's next status to whoever observes."""
        member.news.append(event)
        self._tell(member.uid, event)

    def _may_be_back(self, member: Member) -> bool:
        """Whether there is still hope for it, or no need."""
        return member.lost_at_s is None or self._awake.now_s() - member.lost_at_s < self._patience.back_s

    def _await_anybody(self) -> None:
        """In lockstep time stands still while everybody is cut off."""
        while not any(member.is_there for member in self._members) and any(
            member.lost_at_s is not None and self._may_be_back(member) for member in self._members
        ):
            if self._stop():
                return
            self._mail.wait(range(len(self._members)), timeout_s=LOOK_S)
            self._collect()

    def _await_frames(self, speakers: Sequence[int]) -> None:
        """Until what these have sent is where it must be; whose frame does not come is lost with it."""
        deadline_s = self._awake.now_s() + self._patience.tick_s
        while missing := self._medium.missing(speakers):
            if self._awake.now_s() > deadline_s:
                for uid in missing:
                    self._members[uid].unsay()
                    self._lose(self._members[uid], UNHEARD, was_awaited=True)
                return
            sleep(FRAME_LOOK_S)

    def _on_change(self, key: str, is_there: bool) -> None:
        uid = sender(key)
        if uid is not None and not is_there:
            self._dead.add(uid)
            self._mail.give_up(uid)
