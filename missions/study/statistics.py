"""Means with 95 % intervals.

The interval is Student's t interval of the mean over runs: mean ± t(0.975, R - 1) s / sqrt(R), with the standard
deviation s taken with R - 1. Two points that were flown with the same seeds are compared run by run, by the interval of
the mean of the differences, which is right whether or not their runs resemble each other.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import atan, cos, inf, pi, sin, sqrt
from statistics import NormalDist

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

CONFIDENCE = 0.95
# From here on the series for t takes long, and the first term of its expansion about the normal is good to 1e-6.
_MANY = 500


@dataclass(frozen=True, slots=True)
class Estimate:
    """A mean over runs, and the ends of its interval; NaN and infinite ends where there are too few runs to say."""

    mean: float
    low: float
    high: float
    runs: int

    @property
    def half(self) -> float:
        """Half the interval's width."""
        return (self.high - self.low) / 2


def estimate(values: Floats) -> Estimate:
    """The mean of a number over runs; runs in which there is none (NaN) do not count."""
    known = values[~np.isnan(values)]
    count = len(known)
    if count == 0:
        return Estimate(float("nan"), -inf, inf, 0)
    mean = float(known.mean())
    if count == 1:
        return Estimate(mean, -inf, inf, 1)
    half = student(count - 1) * float(known.std(ddof=1)) / sqrt(count)
    return Estimate(mean, mean - half, mean + half, count)


def estimates(table: Floats) -> tuple[Floats, Floats, Floats]:
    """Mean and ends of the interval for every column of a table of runs (R, S): three times (S)."""
    if len(table) > 1 and not np.isnan(table).any():  # the same, many times as fast
        mean: Floats = table.mean(axis=0)
        half: Floats = student(len(table) - 1) * table.std(axis=0, ddof=1) / sqrt(len(table))
        return mean, mean - half, mean + half
    columns = [estimate(column) for column in table.T]
    return (
        np.array([e.mean for e in columns]),
        np.array([e.low for e in columns]),
        np.array([e.high for e in columns]),
    )


@lru_cache(maxsize=1024)
def student(degrees: int, confidence: float = CONFIDENCE) -> float:
    """The t with P(|T| <= t) = confidence for Student's T with so many degrees of freedom."""
    if degrees > _MANY:
        z = NormalDist().inv_cdf((1 + confidence) / 2)
        return z + (z**3 + z) / (4 * degrees)
    return _solved(lambda t: within(t, degrees), confidence)


def within(t: float, degrees: int) -> float:
    """P(|T| <= t), by the finite series of Abramowitz and Stegun, 26.7.3 and 26.7.4."""
    angle = atan(t / sqrt(degrees))
    if degrees == 1:
        return 2 * angle / pi
    odd = degrees % 2
    term = cos(angle) if odd else 1.0
    total = term
    for k in range(2 if odd else 1, degrees - 2, 2):
        term *= cos(angle) ** 2 * k / (k + 1)
        total += term
    return (angle + sin(angle) * total) * 2 / pi if odd else sin(angle) * total


def _solved(rising: Callable[[float], float], wanted: float) -> float:
    """Where a rising function has the value wanted, by halving."""
    low, high = 0.0, 1.0
    while rising(high) < wanted:
        high *= 2
    for _ in range(80):
        middle = (low + high) / 2
        if rising(middle) < wanted:
            low = middle
        else:
            high = middle
    return high
