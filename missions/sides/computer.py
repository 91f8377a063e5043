"""An agent's computer: the agent, its radio, and the bytes that wait for it. It can stand still, and go out."""

from __future__ import annotations

from msgspec import structs

from comms.radio import MAX_WAITING, Radio
from comms.status import Activity, AgentStatus, Event, Level
from missions.sides.exchange import Cue
from swarm_agent.agent import Agent, Order, Output

# What a link's driver keeps for a computer that does not read it; a second of telemetry is about 3 kB.
MOST_BYTES_WAITING = 65_536
HEARS_MORE = "hears more frames than the world has counted: this flight does not repeat exactly"


class Computer:
    """What runs agent `uid`.

    Attributes:
        agent: another one once the computer has gone out.
    """

    def __init__(self, agent: Agent, radio: Radio) -> None:
        self.agent = agent
        self.radio = radio
        self._out = False
        self._telemetry = b""
        self._backlog = 0  # frames that came while it stood still
        self._has_told = False

    def think(self, cue: Cue, now_s: float) -> Output:
        """One tick of the agent: what it says has been sent.

        Raises:
            RuntimeError: the inbox is not what was sent to it.
        """
        if self._out:
            self._out, self.agent = False, self.agent.begun_anew()
        hears_more = self._check_inbox(cue, now_s)
        order = Order(
            mission_tick=cue.mission_tick,
            come_home=cue.come_home,
            land=cue.land,
            hold=cue.hold,
            explain=cue.explain,
        )
        telemetry, self._telemetry, self._backlog = self._telemetry, b"", 0
        output = self.agent.tick(now_s, order, cue.sightings, self.radio.drain(now_s), telemetry)
        if output.frame is not None and not cue.silent:
            self.radio.send(output.frame)
        if hears_more and not self._has_told:
            self._has_told = True
            events = (*output.status.events, Event(Level.WARNING, HEARS_MORE))
            return output._replace(status=structs.replace(output.status, events=events))
        return output

    def stand_still(self, now_s: float) -> Output:
        """A tick in which nothing runs: what arrives waits."""
        self._backlog = self.radio.waiting(now_s)
        return self._nothing()

    def go_out(self, now_s: float) -> Output:
        """A tick without power: what arrives is gone, and so is all that the agent knew."""
        self._out = True
        self._telemetry, self._backlog = b"", 0
        self.radio.forget(now_s)
        return self._nothing()

    def take(self, telemetry: bytes) -> None:
        """Bytes from the vehicle, for the next tick."""
        if not self._out:
            self._telemetry = (self._telemetry + telemetry)[:MOST_BYTES_WAITING]

    def due(self, cue: Cue) -> int | None:
        """How many frames must be at the radio by now; None where nobody waits for them."""
        return None if cue.frames is None else min(self._backlog + cue.frames, MAX_WAITING)

    def _check_inbox(self, cue: Cue, now_s: float) -> bool:
        """Whether there is more in the inbox than the world knows of, where that may be.

        From radio to radio, of processes (whose cues name a life), anything may come: a mate that dies after its frame
        has not told the world of it, and a hostile one says what it likes. Elsewhere we have counted wrong.
        """
        due = self.due(cue)
        if due is None:
            return False
        waiting = self.radio.waiting(now_s)
        has_more = waiting > due or self.radio.surplus > 0
        if waiting < due or (has_more and not (self.radio.is_open and cue.life)):
            got = f"{waiting + self.radio.surplus} frames arrived of {due}"
            raise RuntimeError(f"lockstep broken at {now_s:.1f} s, agent {self.agent.uid}: {got}")
        return has_more

    def _nothing(self) -> Output:
        return Output(None, b"", AgentStatus(uid=self.agent.uid, activity=Activity.LOST))
