"""What an agent's sensor sees. Scalar rules that missions and studies share; the horizontal plane, meters."""

from __future__ import annotations


def sees(dx_m: float, dy_m: float, range_m: float) -> bool:
    """Omnidirectional sensing: o_j is in SC(v_i, t) when it is within the sensing range r_s (section 3)."""
    return dx_m * dx_m + dy_m * dy_m <= range_m * range_m
