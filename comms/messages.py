"""What agents tell each other: one frame per agent and tick, with tags, help calls and answers in it.

Values in SI units and the mission's ENU frame. `comms.codec` puts them on the wire as integers (mm, mm/s, ms), so a
value that has travelled is rounded to those; `on_wire` gives the same rounding to whoever must compare with it.
"""

from __future__ import annotations

from math import floor
from typing import NamedTuple

from comms.frames import Vec3

VERSION = 1
# Nothing in a mission is farther from home, or faster; whatever says so on any wire is not believed.
FARTHEST_M, FASTEST_M_S = 100_000, 500
# What one frame holds at most; 4096 bytes have room for it.
MAX_TAGS = 64
MAX_CALLS = 48
MAX_ANSWERS = 8


class Tag(NamedTuple):
    """ "I follow this target": its position (m) and velocity (m/s), and the distance (m) that decides who owns it."""

    target: int
    x_m: float
    y_m: float
    vx_m_s: float
    vy_m_s: float
    distance_m: float


class HelpCall(NamedTuple):
    """ "I am about to lose this target", `loss_in_s` after the frame was sent; 0 when it is lost already.

    `seen_ago_s` is how old the position is, at sending: 0 while the caller still sees the target.
    """

    target: int
    x_m: float
    y_m: float
    vx_m_s: float
    vy_m_s: float
    loss_in_s: float
    seen_ago_s: float


class Answer(NamedTuple):
    """ "I take that help call", with the time to capture T_r that decides between several answers."""

    target: int
    capture_s: float


class Sighting(NamedTuple):
    """What an agent's own sensor reports of one target: where it is, ENU meters. Not said to anybody."""

    target: int
    x_m: float
    y_m: float


class Frame(NamedTuple):
    """All that one agent says in one tick. Atomic: it arrives whole or not at all.

    Attributes:
        src: the sender's uid. seq: one more each frame. sent_at_s: mission clock. ttl_s: older than that is stale.
        position_m, velocity_m_s: the sender's own, ENU.
    """

    src: int
    seq: int
    sent_at_s: float
    ttl_s: float
    position_m: Vec3
    velocity_m_s: Vec3
    tags: tuple[Tag, ...] = ()
    help_calls: tuple[HelpCall, ...] = ()
    answers: tuple[Answer, ...] = ()


def thousandths(value: float) -> int:
    """`value` as the wire carries it: in whole thousandths (mm, mm/s, ms), rounded half up."""
    return floor(value * 1000.0 + 0.5)


def on_wire(value: float) -> float:
    """`value` as it will read after its journey: rounded to thousandths (mm, mm/s, ms), half up."""
    return thousandths(value) / 1000.0
