"""Which policy decides: one function for all of them, in flight and in a study."""

from __future__ import annotations

from swarm_agent.bcmommt.belief import Table
from swarm_agent.bcmommt.params import Params, Policy
from swarm_agent.bcmommt.step import Mind
from swarm_agent.bcmommt.step import decide as decide_b_cmommt
from swarm_agent.policies.a_cmommt import decide as decide_a_cmommt
from swarm_agent.policies.basic import decide as decide_basic
from swarm_agent.policies.regions import decide as decide_regions


def decide(
    t: Table, p: Params, mind: Mind, me: int, x: float, y: float, now: float, seed: int, tick: int
) -> tuple[Mind, float, float]:
    """What agent `me` at (x, y) does now by policy `p.policy`: see `bcmommt.step.decide`."""
    if p.policy == Policy.A_CMOMMT:
        return decide_a_cmommt(t, p, mind, me, x, y, now, seed, tick)
    if p.policy == Policy.B_CMOMMT_BASIC:
        return decide_basic(t, p, mind, me, x, y, now, seed, tick)
    if p.policy == Policy.REGIONS:
        return decide_regions(t, p, mind, me, x, y, now, seed, tick)
    return decide_b_cmommt(t, p, mind, me, x, y, now, seed, tick)
