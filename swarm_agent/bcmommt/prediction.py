"""Predictive tracking (section 4.1): targets out of sight that still count, continued linearly."""

from __future__ import annotations

from math import sqrt

from swarm_agent.bcmommt.belief import FAR, Table, predicted_place
from swarm_agent.bcmommt.params import Params
from swarm_agent.bcmommt.profiles import predictive_range_m


def predicted_distance(t: Table, p: Params, j: int, me_x: float, me_y: float, now: float) -> float:
    """How far away target j, out of my sight, is predicted to be; FAR if it is not to be counted on.

    It may be one that left my sight, or one that a mate told of.

    PAPER: the text sets no limit to a prediction's age; ours is the horizon within which losses are predicted. What
    should be in sight and is not there does not count: the text predicts "beyond sensing range".
    """
    if t.sensed[j] or now - t.known_at_s[j] > p.horizon_s:
        return FAR
    x, y = predicted_place(t, p, j, now)
    dx, dy = x - me_x, y - me_y
    distance = sqrt(dx * dx + dy * dy)
    if distance <= p.sensing_range_m:
        return FAR
    return distance


def in_predictive_tracking(t: Table, p: Params, j: int, me_x: float, me_y: float, now: float) -> bool:
    """Whether target j is predicted in the annulus between the sensing range and the predictive tracking range."""
    return predicted_distance(t, p, j, me_x, me_y, now) < predictive_range_m(p)
