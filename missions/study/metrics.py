"""The numbers of a study: each is one value for every run of a point, with a name and a unit for people."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isinf, nan

import numpy as np
import numpy.typing as npt

from missions.study.flown import COUNTS, Flown

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Window:
    """A part of a mission, in seconds since its start; `until_s` None is to the end."""

    from_s: float = 0.0
    until_s: float | None = None

    def __str__(self) -> str:
        if self.until_s is None:
            return "" if self.from_s == 0 else f"from {self.from_s:g} s on"
        return f"{self.from_s:g} to {self.until_s:g} s"


ALL = Window()


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number of a run: what people call it, its unit, and how it comes out of the runs of a point: (R)."""

    label: str
    unit: str
    of: Callable[[Flown, Window], Floats]

    @property
    def is_share(self) -> bool:
        """Whether it lies between 0 and 1 and is told in percent."""
        return self.unit == "%"

    def shown(self, value: float) -> str:
        """A value with its unit: "93.1 %", "3.2 per run"."""
        if value != value or isinf(value):
            return "none"
        if self.is_share:
            return f"{100 * value:.1f} %"
        return f"{value:.3g} {self.unit}".rstrip()

    def with_spread(self, value: float, half: float) -> str:
        """A mean and half its interval: "93.1 % ± 0.4", "3.2 ± 0.5 per run"."""
        if self.is_share:
            return f"{self.shown(value)} ± {self.spread(half)}"
        return f"{value:.3g} ± {self.spread(half)} {self.unit}".rstrip()

    def spread(self, half: float) -> str:
        """Half an interval, without the unit."""
        if half != half or isinf(half):
            return "?"
        return f"{100 * half:.1f}" if self.is_share else f"{half:.2g}"


def _coverage(flown: Flown, window: Window) -> Floats:
    return flown.share(from_s=window.from_s, until_s=window.until_s)


def _late(flown: Flown, window: Window) -> Floats:
    return flown.late


def _utilization(flown: Flown, window: Window) -> Floats:
    return _coverage(flown, window) * flown.n_targets / flown.n_agents


def _lowest(flown: Flown, window: Window) -> Floats:
    """Coverage in the second in which the mean over runs is lowest."""
    start = int(window.from_s)
    shares = flown.share_by_second()[:, start : None if window.until_s is None else int(window.until_s)]
    if shares.size == 0 or np.isnan(shares).all():
        return np.full(len(flown.seeds), nan)
    worst: Floats = shares[:, int(np.nanargmin(np.nanmean(shares, axis=0)))]
    return worst


def _escaped(flown: Flown, window: Window) -> Floats:
    return (1 - _lowest(flown, window)) * flown.n_targets


def _count(column: int) -> Callable[[Flown, Window], Floats]:
    return lambda flown, window: flown.counts[:, column].astype(np.float64)


_COUNT_LABELS = (
    "target losses",
    "target discoveries",
    "tag switches",
    "help calls",
    "answered calls",
    "captures after a call",
    "calls taken over",
    "own losses pursued",
    "own losses found again",
)
QUANTITIES: dict[str, Quantity] = {
    "coverage": Quantity("coverage", "%", _coverage),
    "coverage_late": Quantity("coverage of the last quarter", "%", _late),
    "utilization": Quantity("utilization", "targets per agent", _utilization),
    "lowest": Quantity("lowest coverage", "%", _lowest),
    "escaped": Quantity("targets out of sight at the lowest", "per run", _escaped),
    **{
        name: Quantity(label, "per run", _count(column))
        for column, (name, label) in enumerate(zip(COUNTS, _COUNT_LABELS, strict=True))
    },
}
