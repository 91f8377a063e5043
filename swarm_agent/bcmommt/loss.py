"""When a tag will be lost: the direct and the learned prediction of section 4.2.1."""

from __future__ import annotations

from math import sqrt

from swarm_agent.bcmommt.belief import FAR, NOBODY, Table
from swarm_agent.bcmommt.net import TAUGHT_S, forward, pair_inputs, triple_inputs
from swarm_agent.bcmommt.params import Params, Predictor


def predict_losses(t: Table, p: Params, n_tags: int) -> None:
    """Fill `t.loss_in_s` for every tag: seconds until it leaves the sensing range, FAR if beyond the horizon.

    With one tag, or without a predictor, nothing is ever predicted to be lost.
    """
    if p.predictor == Predictor.PERFECT and n_tags >= 2:
        _keep_foreseen(t, p)
        return
    for j in t.known:
        t.loss_in_s[j] = FAR
    if n_tags < 2:
        return
    if p.predictor == Predictor.LEARNED and n_tags <= 3:
        _predict_learned(t, p, n_tags)
    elif p.predictor != Predictor.NONE:
        _predict_direct(t, p, n_tags)


def _keep_foreseen(t: Table, p: Params) -> None:
    """What the column holds is true; left of it are the losses of tags within the horizon."""
    for j in t.known:
        if not t.tagged[j] or t.loss_in_s[j] > p.horizon_s:
            t.loss_in_s[j] = FAR


def _predict_learned(t: Table, p: Params, n_tags: int) -> None:
    """The net for two or three tags says when the first of them is lost: the same time for all, as in Algorithm 1."""
    a = _tag_after(t, NOBODY)
    b = _tag_after(t, a)
    if n_tags == 2:
        pair = pair_inputs(t.distance_m[a], t.distance_m[b], _gap(t, a, b), p.sensing_range_m)
        after = forward(p.pair_net, pair) * TAUGHT_S
    else:
        c = _tag_after(t, b)
        triple = triple_inputs(
            t.distance_m[a],
            t.distance_m[b],
            t.distance_m[c],
            _gap(t, a, b),
            _gap(t, a, c),
            _gap(t, b, c),
            p.sensing_range_m,
        )
        after = forward(p.triple_net, triple) * TAUGHT_S
    if after <= p.horizon_s:
        for j in t.known:
            if t.tagged[j]:
                t.loss_in_s[j] = after


def _tag_after(t: Table, last: int) -> int:
    """The next tagged target after `last`; NOBODY before the first, and if there is none."""
    for j in t.known:
        if j > last and t.tagged[j]:
            tag: int = j
            return tag
    return NOBODY


def _gap(t: Table, a: int, b: int) -> float:
    """How far apart two targets are."""
    dx, dy = t.x_m[a] - t.x_m[b], t.y_m[a] - t.y_m[b]
    return sqrt(dx * dx + dy * dy)


def _predict_direct(t: Table, p: Params, n_tags: int) -> None:
    """Eq. 10: the agent sits in the center of gravity of its tags; each goes on as it moved last.

    PAPER: eq. 10 prints o_j without its own motion. Both the center and o_j move, so the relative motion counts.
    """
    cx = cy = cvx = cvy = 0.0
    for j in t.known:
        if t.tagged[j]:
            cx += t.x_m[j]
            cy += t.y_m[j]
            cvx += t.vx_m_s[j]
            cvy += t.vy_m_s[j]
    cx, cy, cvx, cvy = cx / n_tags, cy / n_tags, cvx / n_tags, cvy / n_tags
    for j in t.known:
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
