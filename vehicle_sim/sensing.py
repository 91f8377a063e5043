"""What an agent's sensor sees. Scalar rules that missions and studies share; the horizontal plane, meters."""

from __future__ import annotations

from math import floor, sqrt

from comms.chance import IDENTITY_ERROR, draw

ALL_AROUND = -2.0  # no cosine is so small: a sector without limits
STANDING_M_S = 0.05  # an agent slower than this keeps its facing


def sees(dx_m: float, dy_m: float, range_m: float, facing_x: float, facing_y: float, cos_half_opening: float) -> bool:
    """Whether o_j is in SC(v_i, t): within the sensing range r_s, and in the sector that the agent looks into.

    Args:
        dx_m, dy_m: from the agent to the target. facing_x, facing_y: unit vector.
        cos_half_opening: of half the sector's angle, or ALL_AROUND. What is right below is seen.
    """
    squared = dx_m * dx_m + dy_m * dy_m
    if squared > range_m * range_m:
        return False
    return cos_half_opening < -1.0 or dx_m * facing_x + dy_m * facing_y >= cos_half_opening * sqrt(squared)


def facing(was_x: float, was_y: float, vx_m_s: float, vy_m_s: float) -> tuple[float, float]:
    """Where an agent looks (unit vector): along its velocity over ground, or where it did while it stands."""
    squared = vx_m_s * vx_m_s + vy_m_s * vy_m_s
    if squared < STANDING_M_S * STANDING_M_S:
        return was_x, was_y
    speed = sqrt(squared)
    return vx_m_s / speed, vy_m_s / speed


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
