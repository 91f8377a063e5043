"""The learned prediction of section 4.2.1: a small net from distances to the time until the first of the tags is lost.

The weights are plain numbers in tuples, fitted elsewhere. Two tags have the inputs of the paper; three their likeness.
"""

from __future__ import annotations

from math import exp
from typing import Any, NamedTuple

# The output is a share of this: the paper predicts up to 20 s ahead.
TAUGHT_S = 20.0
# Beyond this the sigmoid is 0 or 1 to the last digit but one, and exp still far from its limit.
STEEP = 36.0


class Net(NamedTuple):
    """One hidden layer and one output.

    Attributes:
        hidden: a row per hidden neuron: a weight for every input, its bias, its weight in the output. Tuples in flight,
            a two-dimensional array in a study. bias: of the output.
    """

    hidden: Any
    bias: float


# A net that has learned nothing: it says .5 whatever it is given.
BLANK = Net(((0.0,) * 8,), 0.0)


def sigmoid(x: float) -> float:
    """1 / (1 + e^-x)."""
    return 1.0 / (1.0 + exp(-max(-STEEP, min(STEEP, x))))


def forward(net: Net, inputs: tuple[float, ...]) -> float:
    """The net's output, from 0 to 1."""
    n = len(inputs)
    total = net.bias
    for k in range(len(net.hidden)):
        neuron = net.hidden[k]
        drive = neuron[n]
        for i in range(n):
            drive += neuron[i] * inputs[i]
        total += neuron[n + 1] * sigmoid(drive)
    return sigmoid(total)


def pair_inputs(distance_1: float, distance_2: float, gap: float, range_m: float) -> tuple[float, float, float]:
    """What the net for two tags sees: both distances from the agent over r_s, the gap between them over 2 r_s.

    The nearer comes first, so that the two may be exchanged.
    """
    near, far = min(distance_1, distance_2), max(distance_1, distance_2)
    return near / range_m, far / range_m, gap / (2.0 * range_m)


def triple_inputs(
    distance_1: float, distance_2: float, distance_3: float, gap_12: float, gap_13: float, gap_23: float, range_m: float
) -> tuple[float, float, float, float, float, float]:
    """What the net for three tags sees: three distances over r_s, then of each target the gap between the other two.

    Ordered by distance (equal ones: by gap), so that the three may be exchanged; gaps are over 2 r_s.
    """
    d1, g1, d2, g2 = in_order(distance_1, gap_23, distance_2, gap_13)
    d2, g2, d3, g3 = in_order(d2, g2, distance_3, gap_12)
    d1, g1, d2, g2 = in_order(d1, g1, d2, g2)
    wide = 2.0 * range_m
    return d1 / range_m, d2 / range_m, d3 / range_m, g1 / wide, g2 / wide, g3 / wide


def in_order(d1: float, g1: float, d2: float, g2: float) -> tuple[float, float, float, float]:
    """The two pairs (d, g), the smaller first."""
    if d2 < d1 or (d2 == d1 and g2 < g1):
        return d2, g2, d1, g1
    return d1, g1, d2, g2
