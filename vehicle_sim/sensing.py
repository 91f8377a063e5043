"""What an agent's sensor sees. Scalar rules that missions and studies share; the horizontal plane, meters."""

from __future__ import annotations

from math import floor

from comms.chance import IDENTITY_ERROR, draw


def sees(dx_m: float, dy_m: float, range_m: float) -> bool:
    """Omnidirectional sensing: o_j is in SC(v_i, t) when it is within the sensing range r_s (section 3)."""
    return dx_m * dx_m + dy_m * dy_m <= range_m * range_m


def reported(target: int, n_targets: int, identity_error: float, agent: int, seed: int, tick: int) -> int:
    """Under which name `agent` sees `target`: with probability `identity_error` under another's (section 6, fig. 20).

    All other targets are equally likely, present or not; where there is no other, the name is right.
    """
    # PAPER: nothing is said of how long a wrong name lasts. Here every sighting of every tick is drawn by itself.
    if identity_error <= 0.0 or n_targets < 2:
        return target
    chance = draw(seed, tick, agent * n_targets + target, IDENTITY_ERROR)
    if chance >= identity_error:
        return target
    # Given that the name is wrong, chance / identity_error is again uniform in [0, 1); rounded, it may be 1.
    other = min(floor(chance / identity_error * (n_targets - 1)), n_targets - 2)
    return other if other < target else other + 1
