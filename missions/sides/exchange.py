"""What the world and an agent tell each other in a tick: values, which travel as MessagePack where they must.

A `Cue` begins tick k for one agent; its `Done` tells what came of it, with the vehicle as it is at k + 1. The `Done`
before the first cue, of tick -1, says that an agent is there.

Where agents are processes, both name a *life*: a number that a process draws when it starts. The world lets one life of
an agent in, by its first `Done`, and heeds no other; a process heeds no cue but those for its own. The world has a
life, too: another world's ticks begin anew, and so who has met one heeds no other.
"""

from __future__ import annotations

from typing import Annotated

import msgspec

from comms.messages import Sighting
from comms.status import AgentStatus
from missions.observation import AgentTruth

HELLO_TICK = -1
# Sums over all agents, and over all their lives, stay within what travels as an integer.
Count = Annotated[int, msgspec.Meta(ge=0, le=2**48)]


class Cue(msgspec.Struct, frozen=True, kw_only=True, array_like=True):
    """The world to one agent: this tick begins.

    Attributes:
        tick: ticks since power-on. mission_tick: since MISSION began; None outside it.
        fault_tick: since MISSION began, after its end too: the time of the mission's faults.
        come_home: the mission is over: return and land. land: land on the spot. hold: stay where it is, on duty.
        explain: somebody wants to know what the agent knows.
        sightings: what the agent's sensor sees now.
        frames: how many have been sent to its radio for this tick; None where nobody waits for them (real time).
        late_s: how late the tick began, on the wall clock.
        silent: whatever the agent would say by radio is not sent.
        life: whom it is for. refused: why that one is not let in; the rest of the cue means nothing then.
        world: the life of the world that says it.
    """

    tick: int
    mission_tick: int | None = None
    fault_tick: int | None = None
    come_home: bool = False
    land: bool = False
    hold: bool = False
    explain: bool = False
    sightings: tuple[Sighting, ...] = ()
    frames: int | None = 0
    late_s: float = 0.0
    silent: bool = False
    life: int = 0
    refused: str = ""
    world: int = 0


class LinkCount(msgspec.Struct, frozen=True, array_like=True):
    """MAVLink messages of one end of a link so far."""

    sent: Count = 0
    received: Count = 0
    bad: Count = 0
    dropped: Count = 0

    def __add__(self, other: LinkCount) -> LinkCount:
        return LinkCount(
            self.sent + other.sent, self.received + other.received, self.bad + other.bad, self.dropped + other.dropped
        )


class RadioTally(msgspec.Struct, frozen=True, array_like=True):
    """An agent's radio so far: frames and bytes sent, frames heard and believed, frames refused."""

    sent: Count = 0
    bytes: Count = 0
    heard: Count = 0
    refused: Count = 0

    def __add__(self, other: RadioTally) -> RadioTally:
        return RadioTally(
            self.sent + other.sent, self.bytes + other.bytes, self.heard + other.heard, self.refused + other.refused
        )


class Done(msgspec.Struct, frozen=True, kw_only=True, array_like=True):
    """One agent to the world: this tick is done.

    Attributes:
        status: as it sees itself. truth, on_ground: its vehicle as it is at the next tick.
        spoke: it has sent a frame. ready: on its layer, waiting for the mission.
        unheard: its pilot has given up and its vehicle is not heard: it will not end otherwise.
        pilot, vehicle: MAVLink so far, of the agent and of its vehicle if that is simulated.
        radio: what went over its radio.
        leaves: it has landed, and is asked to end: nobody need wait for it any longer.
        fingerprint: in the first one, of the mission that it was given.
        life: of the process that says it. world: the life of the world that this one has met; 0: it has met none.
    """

    tick: int
    status: AgentStatus
    truth: AgentTruth
    on_ground: bool
    spoke: bool = False
    ready: bool = False
    unheard: bool = False
    pilot: LinkCount = LinkCount()
    vehicle: LinkCount = LinkCount()
    radio: RadioTally = RadioTally()
    leaves: bool = False
    fingerprint: str = ""
    life: int = 0
    world: int = 0
