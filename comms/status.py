"""What an agent tells the observer: its status each tick. Never read by another agent, and not range-limited."""

from __future__ import annotations

from enum import StrEnum

import msgspec

from comms.frames import Vec3
from comms.knowledge import Knowledge


class Activity(StrEnum):
    """What an agent is doing, as a person watching would say it. One color each, everywhere."""

    PREPARING = "preparing"  # connect, preflight, takeoff, waiting for the others
    TAKEN_OVER = "taken over"  # a person flies the vehicle: the agent's hands are off
    EXPLORE = "explore"
    FOLLOW = "follow"
    CALLING = "calling for help"  # following, with an urgent help call out
    HELPING = "helping"
    RETURNING = "returning"  # return, land, disarm
    LANDED = "landed"
    LOST = "lost"


# Then an agent follows nobody, and leaves targets to nobody.
OFF_DUTY = frozenset({Activity.PREPARING, Activity.TAKEN_OVER, Activity.RETURNING, Activity.LANDED, Activity.LOST})


class Level(StrEnum):
    """How serious a line of the event log is."""

    INFO = "info"
    WARNING = "warning"
    ERROR = "error"


class Event(msgspec.Struct, frozen=True):
    """One line of the event log: something an agent or its autopilot said."""

    level: Level
    text: str


class HelpCallStatus(msgspec.Struct, frozen=True):
    """A help call that is out: for which target, and in how many seconds it is expected to be lost.

    Not urgent is a call for a target whose loss is not foreseen: it is on offer to whoever is free.
    """

    target: int
    loss_in_s: float
    urgent: bool = True


class AgentStatus(msgspec.Struct, frozen=True, kw_only=True):
    """One agent at one tick, as it sees itself. Positions in the mission's ENU frame, meters.

    Attributes:
        uid: the agent's number, from 0; that of its vehicle on MAVLink is another.
        position_m, velocity_m_s: own estimate, ENU; None until the autopilot has a position.
        heading_rad: where the nose points, clockwise from north.
        battery: remaining share, 0 to 1; None when unknown.
        tags: targets it follows (owns). calls: help calls out. helping: the target it flies to for a mate, or None.
        mates: the agents whose frames arrived this tick.
        flight_mode: the autopilot's mode, in its own words ("GUIDED").
        events: new since the last tick. knowledge: when it was asked for.
    """

    uid: int
    activity: Activity
    position_m: Vec3 | None = None
    velocity_m_s: Vec3 | None = None
    heading_rad: float = 0.0
    battery: float | None = None
    tags: tuple[int, ...] = ()
    calls: tuple[HelpCallStatus, ...] = ()
    helping: int | None = None
    mates: tuple[int, ...] = ()
    flight_mode: str = ""
    events: tuple[Event, ...] = ()
    knowledge: Knowledge | None = None
