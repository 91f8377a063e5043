"""What one agent knew and why it did what it did: told to the observer when somebody records, and to nobody else."""

from __future__ import annotations

import msgspec

Place = tuple[float, float]


class Belief(msgspec.Struct, frozen=True, kw_only=True, array_like=True):
    """What an agent believes of one target.

    Attributes:
        place_m: where it is now: the last known position continued, ENU meters east and north.
        age_s: how old that last position is. sensed: the agent sees it itself.
        owner: who follows it, the agent itself too. caller: who calls for help with it.
        loss_in_s: when the caller, or the agent itself, expects to lose it; 0 when it is lost already.
        answerer: who is on its way. capture_s: when the answerer expects to be there.
        None: nobody, or not known.
    """

    target: int
    place_m: Place
    age_s: float = 0.0
    sensed: bool = False
    owner: int | None = None
    caller: int | None = None
    loss_in_s: float | None = None
    answerer: int | None = None
    capture_s: float | None = None


class Mate(msgspec.Struct, frozen=True, array_like=True):
    """Another agent, as last heard: its uid, where it was (ENU meters), and how long ago."""

    uid: int
    place_m: Place
    age_s: float


class Knowledge(msgspec.Struct, frozen=True, kw_only=True, array_like=True):
    """What an agent knew at one tick, after it had decided.

    Attributes:
        beliefs: by target, without those nobody has spoken of lately. mates: by uid, those heard lately.
        wanted_m_s: the velocity it decided for, east and north. why: the reason, in words.
        mavlink: of each kind of message that its autopilot sends, the newest frame since it told last.
    """

    beliefs: tuple[Belief, ...] = ()
    mates: tuple[Mate, ...] = ()
    wanted_m_s: Place = (0.0, 0.0)
    why: str = ""
    mavlink: tuple[bytes, ...] = ()
