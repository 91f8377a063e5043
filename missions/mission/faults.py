"""What a mission lets go wrong: one section a kind. Times count from the moment the mission begins.

Which agents a fault is about is told by their numbers; null is all of them. `at_s` is when it begins; a fault that
lasts has `for_s`, and null is to the end.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from missions.mission.agents import MOST_AGENTS
from missions.mission.part import Allowed, Part, tag_by
from missions.mission.vehicle import Airspeed, Bearing

Uid = Annotated[int, Field(ge=0, lt=MOST_AGENTS)]
UIDS = "a list of agents' numbers, from 0"
Uids = Annotated[tuple[Uid, ...], Field(strict=False, min_length=1), Allowed(UIDS)]
AnyUids = Annotated[Uids | None, Field(strict=False), Allowed(f"{UIDS}, or null: all")]
GROUPS = "a list of two or more lists of agents' numbers, from 0, such as [[0, 1, 2], [3, 4]]"
Offset = Annotated[float, Field(ge=-10_000, le=10_000)]
Instant = Annotated[float, Field(ge=0, le=1_000_000)]
Lasting = Annotated[float | None, Field(gt=0, le=1_000_000)]


KINDS = (
    "kill", "freeze", "reboot", "silence", "loss", "bursts", "latency", "partition", "gps_lost", "gps_glitch",
    "battery_low", "wind", "identity",
)  # fmt: skip


class Fault(Part):
    """Something that goes wrong at a time of its own."""

    kind: str
    """What goes wrong."""
    at_s: Instant
    """When, since the mission began."""

    @property
    def what(self) -> str:
        """What goes wrong, in words."""
        return self.kind.replace("_", " ")


class LastingFault(Fault):
    """Something that goes wrong, and after a while is right again."""

    for_s: Lasting = None
    """For how long; null: to the end."""


class Kill(LastingFault):
    """An agent's computer goes out, with all it knew. Its vehicle flies on, by nobody's orders."""

    kind: Literal["kill"]
    """The computer goes out; after `for_s` it is switched on again, and knows nothing."""
    agents: Uids
    """Whose."""


class Freeze(LastingFault):
    """An agent's computer stands still, and then goes on where it was."""

    kind: Literal["freeze"]
    """The computer stands still."""
    agents: Uids
    """Whose."""


class Reboot(Fault):
    """An autopilot loses its power for a moment: its motors stop, and it boots where it comes to lie."""

    kind: Literal["reboot"]
    """The autopilot loses its power for a moment, and falls."""
    agents: Uids
    """Whose."""


class Silence(LastingFault):
    """An agent's radio is dead: it hears nothing and is not heard."""

    kind: Literal["silence"]
    """The radio is dead, both ways."""
    agents: Uids
    """Whose."""


class Loss(LastingFault):
    """Frames are lost at random, beside those that the radio loses anyway."""

    kind: Literal["loss"]
    """Frames are lost at random."""
    share: Annotated[float, Field(gt=0, le=1)] = 0.3
    """Probability that a frame does not reach a receiver."""
    agents: AnyUids = None
    """On the links of these agents, both ways."""

    @property
    def what(self) -> str:
        """What goes wrong, in words."""
        return f"loss of {self.share:.0%}"


class Bursts(LastingFault):
    """Links fail for a while, one by one and again and again."""

    kind: Literal["bursts"]
    """Links fail for a while, one by one."""
    share: Annotated[float, Field(gt=0, lt=1)] = 0.3
    """How much of the time a link is down, in the mean."""
    burst_s: Annotated[float, Field(gt=0, le=3600)] = 2.0
    """How long a link is down at least."""
    agents: AnyUids = None
    """The links of these agents, both ways."""

    @property
    def what(self) -> str:
        """What goes wrong, in words."""
        return f"bursts of {self.burst_s:g} s, {self.share:.0%} of the time"


class Latency(LastingFault):
    """Frames take longer."""

    kind: Literal["latency"]
    """Frames take longer."""
    latency_s: Annotated[float, Field(gt=0, le=60)] = 0.3
    """How much longer."""
    agents: AnyUids = None
    """On the links of these agents, both ways."""

    @property
    def what(self) -> str:
        """What goes wrong, in words."""
        return f"latency of {self.latency_s:g} s"


class Partition(LastingFault):
    """The swarm falls into groups that do not hear each other."""

    kind: Literal["partition"]
    """The swarm falls into groups that do not hear each other."""
    groups: Annotated[
        tuple[Annotated[tuple[Uid, ...], Field(strict=False)], ...],
        Field(strict=False, min_length=2, max_length=MOST_AGENTS),
        Allowed(GROUPS),
    ]
    """Who still hears whom; agents in no group hear nobody."""

    @property
    def agents(self) -> None:
        """It is about all of them."""


class GpsLost(LastingFault):
    """A GPS receiver has no fix."""

    kind: Literal["gps_lost"]
    """The GPS has no fix."""
    agents: AnyUids = None
    """Whose."""


class GpsGlitch(LastingFault):
    """A GPS receiver is elsewhere than it says."""

    kind: Literal["gps_glitch"]
    """The GPS jumps."""
    east_m: Offset = 0.0
    """By how much to the east."""
    north_m: Offset = 20.0
    """By how much to the north."""
    agents: AnyUids = None
    """Whose."""

    @property
    def what(self) -> str:
        """What goes wrong, in words."""
        return f"gps glitch, {self.east_m:g} m east and {self.north_m:g} m north"


class BatteryLow(Fault):
    """A battery turns out to be nearly empty."""

    kind: Literal["battery_low"]
    """The battery is nearly empty, and empties as it is used."""
    charge: Annotated[float, Field(gt=0, le=1)] = 0.1
    """Share of its capacity that is left."""
    agents: Uids
    """Whose."""

    @property
    def what(self) -> str:
        """What goes wrong, in words."""
        return f"battery at {self.charge:.0%}"


class WindChange(LastingFault):
    """Wind comes up, in place of what the mission has."""

    kind: Literal["wind"]
    """Wind comes up."""
    speed_m_s: Airspeed = 8.0
    """Mean speed."""
    from_deg: Bearing = 0.0
    """Where it comes from, clockwise from north."""
    gust_m_s: Airspeed = 0.0
    """Greatest change of speed by gusts."""
    agents: AnyUids = None
    """Whose vehicles it reaches."""

    @property
    def what(self) -> str:
        """What goes wrong, in words."""
        return f"wind of {self.speed_m_s:g} m/s from {self.from_deg:g}°, gusts {self.gust_m_s:g} m/s"


class IdentityErrors(LastingFault):
    """Targets are taken for others."""

    kind: Literal["identity"]
    """Targets are taken for others."""
    identity_error: Annotated[float, Field(gt=0, le=1)] = 0.1
    """Probability, each tick, that a target seen is taken for another one; if the mission's own is not greater."""
    agents: AnyUids = None
    """By these agents."""

    @property
    def what(self) -> str:
        """What goes wrong, in words."""
        return f"identity errors of {self.identity_error:.0%}"


AnyFault = Annotated[
    Annotated[Kill, Tag("kill")]
    | Annotated[Freeze, Tag("freeze")]
    | Annotated[Reboot, Tag("reboot")]
    | Annotated[Silence, Tag("silence")]
    | Annotated[Loss, Tag("loss")]
    | Annotated[Bursts, Tag("bursts")]
    | Annotated[Latency, Tag("latency")]
    | Annotated[Partition, Tag("partition")]
    | Annotated[GpsLost, Tag("gps_lost")]
    | Annotated[GpsGlitch, Tag("gps_glitch")]
    | Annotated[BatteryLow, Tag("battery_low")]
    | Annotated[WindChange, Tag("wind")]
    | Annotated[IdentityErrors, Tag("identity")],
    Discriminator(tag_by("kind", {kind: kind for kind in KINDS}, required=True)),
]
Faults = Annotated[
    tuple[AnyFault, ...],
    Field(strict=False, max_length=1000),
    Allowed("a list of at most 1000 faults, such as [{kind: kill, at_s: 60, agents: [3]}]"),
]
VEHICLE_FAULTS = (Reboot, GpsLost, GpsGlitch, BatteryLow, WindChange)
"""Those of what a simulated vehicle is made of; a real one has its own."""
RADIO_FAULTS = (Silence, Loss, Bursts, Latency, Partition)
"""Those of a simulated radio; a real one has its own."""
