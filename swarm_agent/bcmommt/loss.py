"""When a tag will be lost: the direct prediction of section 4.2.1."""

from __future__ import annotations

from math import sqrt

from swarm_agent.bcmommt.belief import FAR, Table
from swarm_agent.bcmommt.params import Params, Predictor


def predict_losses(t: Table, p: Params, n_tags: int) -> None:
    """Fill `t.loss_in_s` for every tag: seconds until it leaves the sensing range, FAR if beyond the horizon.

    With one tag, or without a predictor, nothing is ever predicted to be lost.
    """
    for j in range(len(t.tagged)):
        t.loss_in_s[j] = FAR
    if n_tags >= 2 and p.predictor == Predictor.DIRECT:
        _predict_direct(t, p, n_tags)


def _predict_direct(t: Table, p: Params, n_tags: int) -> None:
    """Eq. 10: the agent sits in the center of gravity of its tags; each goes on as it moved last.

    PAPER: eq. 10 prints o_j without its own motion. Both the center and o_j move, so the relative motion counts.
    """
    cx = cy = cvx = cvy = 0.0
    for j in range(len(t.tagged)):
        if t.tagged[j]:
            cx += t.x_m[j]
            cy += t.y_m[j]
            cvx += t.vx_m_s[j]
            cvy += t.vy_m_s[j]
    cx, cy, cvx, cvy = cx / n_tags, cy / n_tags, cvx / n_tags, cvy / n_tags
    for j in range(len(t.tagged)):
        if t.tagged[j]:
            after = time_to_leave(t.x_m[j] - cx, t.y_m[j] - cy, t.vx_m_s[j] - cvx, t.vy_m_s[j] - cvy, p.sensing_range_m)
            if after <= p.horizon_s:
                t.loss_in_s[j] = after


def time_to_leave(x: float, y: float, vx: float, vy: float, radius: float) -> float:
    """When a point at (x, y) with velocity (vx, vy) crosses the circle |.| = radius outward: 0 if out, FAR if never."""
    outside = x * x + y * y - radius * radius
    if outside >= 0.0:
        return 0.0
    speed2 = vx * vx + vy * vy
    if speed2 < 1e-12:
        return FAR
    along = x * vx + y * vy
    return (sqrt(along * along - speed2 * outside) - along) / speed2
