"""The constants of the algorithm. Names, units and defaults: see the mission reference."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from comms.arena import Arena
from swarm_agent.bcmommt.net import BLANK, Net


class Policy(IntEnum):
    """How agents decide."""

    A_CMOMMT = 0  # Parker: the force sum of eq. 2
    B_CMOMMT_BASIC = 1  # section 4.1: help is called when a target is lost
    B_CMOMMT = 2  # section 4.2, Algorithm 1
    REGIONS = 3  # Jung & Sukhatme: agents spread over regions as targets do


class Predictor(IntEnum):
    """How the time of loss is predicted."""

    NONE = 0  # never: no help is called
    DIRECT = 1  # eq. 10
    LEARNED = 2  # a net for two tags and one for three, eq. 10 above that
    PERFECT = 3  # theorem 2's assumption: whoever knows the world has filled the column loss_in_s


class Call(IntEnum):
    """For which of several tags help is called."""

    PREDICTED = 0  # those predicted to be lost within the horizon
    ALL_BUT_NEAREST = 1  # all others too (Algorithm 1, where only the first loss is known)


class Gate(IntEnum):
    """Which calls may be answered."""

    IN_TIME = 0  # capture comes before loss
    ALWAYS = 1


class Answering(IntEnum):
    """Who decides which call an agent answers."""

    DISTRIBUTED = 0  # each agent for itself, by what it hears (section 4.2.2)
    OPTIMAL = 1  # a referee who knows all calls and all agents (eq. 15): `Mind.helping` is its word


class Capture(IntEnum):
    """How the time to capture is estimated."""

    WORST_CASE = 0  # eq. 13: the target flees straight away from the helper
    INTERCEPT = 1  # eq. 11: it keeps its course, continued linearly


class Explore(IntEnum):
    """Where to fly with nothing to follow and nobody to help."""

    PERSISTENT_WALK = 0
    STALE_FIRST = 1


class Params(NamedTuple):
    """Everything the rules read that does not change during a mission. Distances in m, times in s, speeds in m/s.

    The nets are read by `Predictor.LEARNED` alone.
    """

    arena: Arena
    tick_s: float
    sensing_range_m: float
    agent_speed_m_s: float
    target_speed_m_s: float
    standoff_m: float
    turn_time_s: float
    horizon_s: float
    help_margin_s: float
    tag_lease_s: float
    help_lease_s: float
    memory_s: float
    follow_gain_per_s: float
    predictor: int
    call: int
    gate: int
    capture: int
    commitment: bool
    explore: int
    answering: int = Answering.DISTRIBUTED
    policy: int = Policy.B_CMOMMT
    pair_net: Net = BLANK
    triple_net: Net = BLANK


def with_range(p: Params, sensing_range_m: float) -> Params:
    """The same constants for an agent that senses so far: r_s(v_i). Spelled out, since `_replace` does not compile."""
    return Params(
        p.arena,
        p.tick_s,
        sensing_range_m,
        p.agent_speed_m_s,
        p.target_speed_m_s,
        p.standoff_m,
        p.turn_time_s,
        p.horizon_s,
        p.help_margin_s,
        p.tag_lease_s,
        p.help_lease_s,
        p.memory_s,
        p.follow_gain_per_s,
        p.predictor,
        p.call,
        p.gate,
        p.capture,
        p.commitment,
        p.explore,
        p.answering,
        p.policy,
        p.pair_net,
        p.triple_net,
    )
