"""The agents of a mission in processes of their own, as the world sees them: the barrier of each tick.

A tick is published as one cue an agent; it is over when every agent's done is there. An agent that does not answer in
time, or whose process is seen to die, is lost: that is told, and nobody waits for it until it says hello again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import monotonic, sleep

from msgspec import structs

from comms.clock import Awake
from comms.keys import Keys, sender
from comms.mailbox import Mailbox
from comms.session import Network
from comms.status import Activity, Event, Level
from missions.daemons.wire import OVER, decode_done, encode
from missions.sides.exchange import HELLO_TICK, Cue, Done
from missions.sides.medium import Medium

LOOK_S = 0.2
AWAKE_S = 1.0  # between two looks of ours; what is more, we have stood still ourselves
FRAME_LOOK_S = 1e-4
STRANGE = "has another mission, or another --speed, and is not let in: are its file and options the world's?"


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
        n_agents: int,
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
        self._tell = tell
        self._stop = stop
        self._mail = Mailbox(range(n_agents))
        self._puts = [bus.publisher(keys.cue(uid)) for uid in range(n_agents)]
        self._missing = set(range(n_agents))  # not met, lost, or left
        self._dones: dict[int, Done] = {}
        self._awake = Awake(most_s=AWAKE_S)
        self._heard_at_s: dict[int, float] = {}
        self._new: set[int] = set()  # its radio has not been waiting for what is under way
        self._dead: set[int] = set()  # seen to die, from another thread
        self._lost_at_s: dict[int, float] = {}
        self._news: dict[int, list[Event]] = {}
        self._strangers: set[int] = set()
        self._tick = HELLO_TICK  # under way
        bus.subscribe(keys.every_done, lambda key, payload: self._mail.put(sender(key), payload))
        bus.watch(keys.every_alive, self._on_change)

    def hello(self) -> list[Done]:
        """Wait until everybody is there.

        Raises:
            CrewError: somebody is not, in time.
        """
        deadline_s = monotonic() + self._patience.join_s
        while self._missing:
            self._mail.wait(self._missing, timeout_s=LOOK_S)
            self._collect()
            if self._missing and self._stop():
                raise CrewError("asked to end before everybody was there")
            if self._missing and monotonic() > deadline_s:
                names = ", ".join(map(str, sorted(self._missing)))
                raise CrewError(f"no sign of agent {names} for {self._patience.join_s:g} s")
        self.lost.clear()
        self._new.clear()
        self._news.clear()
        return [self._dones[uid] for uid in sorted(self._dones)]

    def tick(self, cues: Sequence[Cue]) -> list[Done]:
        """Let everybody who is there do its tick; who is not is LOST, where it was last.

        Raises:
            RuntimeError: in lockstep, a frame that was sent did not arrive.
        """
        self._collect()
        if self._patience.lockstep:
            self._await_anybody()
        tick, waiting = cues[0].tick, {uid for uid in self._dones if uid not in self._missing}
        self._tick = tick
        for uid in waiting:
            unchecked = uid in self._new or not self._patience.lockstep
            self._puts[uid](encode(structs.replace(cues[uid], frames=None) if unchecked else cues[uid]))
        self._new.clear()
        deadline_s = self._awake.now_s() + self._patience.tick_s
        while waiting and (left_s := deadline_s - self._awake.now_s()) > 0.0:
            self._mail.wait(waiting, timeout_s=min(LOOK_S, left_s))
            self._collect()
            waiting = {uid for uid in waiting - self._missing if self._dones[uid].tick != tick}
        for uid in waiting:
            silent_s = self._awake.now_s() - self._heard_at_s[uid]
            if self._patience.lockstep or silent_s > self._patience.lost_s:
                self._lose(uid, f"no answer for {silent_s:.0f} s: lost")
        dones = [self._now(uid, tick) for uid in range(len(cues))]
        if self._patience.lockstep:
            self._await_frames(sum(done.spoke for done in dones))
        return dones

    def dismiss(self) -> None:
        """The mission is over: everybody may go."""
        for put in self._puts:
            put(OVER)

    def _collect(self) -> None:
        """Take in what has come, and who has died."""
        for uid, wires in self._mail.take().items():
            for wire in wires:
                done = decode_done(wire, uid)
                if done is not None:
                    self._hear(uid, done)
        while self._dead:
            uid = self._dead.pop()
            if uid in self._dones and uid not in self._missing:
                self._lose(uid, "its process has died, or its link is cut")

    def _hear(self, uid: int, done: Done) -> None:
        if done.tick == HELLO_TICK and done.fingerprint != self._fingerprint:
            if uid not in self._strangers:
                self._strangers.add(uid)
                self._tell(uid, Event(Level.ERROR, STRANGE))
            return
        if done.tick > self._tick:
            return  # of a tick that has not begun
        if uid in self._missing:
            if uid in self._dones:
                done = structs.replace(done, spoke=False)
                self._say(uid, Event(Level.WARNING, "its process is back"))
            self._missing.discard(uid)
            self._lost_at_s.pop(uid, None)
            self._new.add(uid)
        elif done.tick == HELLO_TICK:
            return  # said again before our cue came
        self._news.setdefault(uid, []).extend(done.status.events)
        if uid in self._dones and HELLO_TICK < done.tick < self._dones[uid].tick:
            return  # late: we know better by now
        self._dones[uid] = structs.replace(done, status=structs.replace(done.status, events=()))
        self._heard_at_s[uid] = self._awake.now_s()
        if done.leaves:
            self._missing.add(uid)

    def _lose(self, uid: int, why: str) -> None:
        self._missing.add(uid)
        self.lost.add(uid)
        self._say(uid, Event(Level.ERROR, why))
        last = self._dones[uid]
        gone = structs.replace(last.status, activity=Activity.LOST, tags=(), calls=(), helping=None, mates=())
        self._dones[uid] = structs.replace(last, status=gone, ready=False)
        self._lost_at_s[uid] = self._awake.now_s()

    def _say(self, uid: int, event: Event) -> None:
        """To whoever watches, and with the agent's next status to whoever observes."""
        self._news.setdefault(uid, []).append(event)
        self._tell(uid, event)

    def _now(self, uid: int, tick: int) -> Done:
        """What is known of an agent in this tick: its done, or its last one with nothing new but what came late."""
        done, status = self._dones[uid], self._dones[uid].status
        if done.tick != tick:
            done, status = structs.replace(done, spoke=False), structs.replace(status, knowledge=None)
        if not self._may_be_back(uid):
            done = structs.replace(done, on_ground=True, unheard=True)
        news = self._news.pop(uid, None)
        return structs.replace(done, status=structs.replace(status, events=tuple(news)) if news else status)

    def _may_be_back(self, uid: int) -> bool:
        lost_at_s = self._lost_at_s.get(uid)
        return lost_at_s is None or self._awake.now_s() - lost_at_s < self._patience.back_s

    def _await_anybody(self) -> None:
        """In lockstep time stands still while everybody is cut off."""
        while self._dones.keys() <= self._missing and any(self._may_be_back(uid) for uid in self._lost_at_s):
            if self._stop():
                return
            self._mail.wait(self._lost_at_s, timeout_s=LOOK_S)
            self._collect()

    def _await_frames(self, n_frames: int) -> None:
        deadline_s = monotonic() + self._patience.tick_s
        while not self._medium.has(n_frames):
            if monotonic() > deadline_s:
                raise RuntimeError(f"lockstep broken: not all of {n_frames} frames arrived")
            sleep(FRAME_LOOK_S)

    def _on_change(self, key: str, is_there: bool) -> None:
        uid = sender(key)
        if uid is not None and not is_there:
            self._dead.add(uid)
            self._mail.give_up(uid)
