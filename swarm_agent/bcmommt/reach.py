"""How long a helper needs until a target is within its sensor's range: the time to capture T_r."""

from __future__ import annotations

from math import sqrt

from swarm_agent.bcmommt.belief import FAR, Table, predicted_place
from swarm_agent.bcmommt.params import Capture, Params

HOPELESS_S = 3600.0  # whoever would need longer cannot help


def time_to_capture(t: Table, p: Params, j: int, me_x: float, me_y: float, now: float) -> float:
    """T_r for an agent at (me_x, me_y) and target j: never below `turn_time_s`, FAR if it cannot be caught."""
    x, y = predicted_place(t, p, j, now)
    dx, dy = x - me_x, y - me_y
    if p.capture == Capture.INTERCEPT:
        capture = intercept_time(dx, dy, t.vx_m_s[j], t.vy_m_s[j], p)
    else:
        capture = worst_case_time(sqrt(dx * dx + dy * dy), p)
    return capture if capture <= HOPELESS_S else FAR


def worst_case_time(distance: float, p: Params) -> float:
    """Eq. 13: the target flees straight away from the helper.

    PAPER: d_j is the HELPER's distance to the target ("the robot that has tagged it when answering").
    """
    gap = distance - p.sensing_range_m
    if gap <= 0.0:
        return p.turn_time_s
    closing = p.agent_speed_m_s - p.target_speed_m_s
    if closing <= 0.0:
        return FAR
    return min(gap / closing + p.turn_time_s, FAR)


def intercept_time(dx: float, dy: float, vx: float, vy: float, p: Params) -> float:
    """Eq. 11 with the target continued linearly: the least t with |d + v t| <= r_s + s_v (t - turn time).

    Args:
        dx, dy: the target's position relative to the helper, m. vx, vy: its velocity, m/s.
    """
    # From the end of the turn on, with the target's position then: |d + v u| = r_s + s_v u.
    dx += vx * p.turn_time_s
    dy += vy * p.turn_time_s
    reach, speed = p.sensing_range_m, p.agent_speed_m_s
    c = dx * dx + dy * dy - reach * reach
    if c <= 0.0:
        return p.turn_time_s
    a = vx * vx + vy * vy - speed * speed
    b = dx * vx + dy * vy - reach * speed
    if abs(a) < 1e-9:
        return min(p.turn_time_s - c / (2.0 * b), FAR) if b < 0.0 else FAR
    root2 = b * b - a * c
    if root2 < 0.0:
        return FAR
    root = sqrt(root2)
    # c > 0: with a < 0 (the helper is faster) the roots have opposite signs, with a > 0 equal ones.
    after = (-b - root) / a
    return min(p.turn_time_s + after, FAR) if after > 0.0 else FAR
