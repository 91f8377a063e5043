"""How figures look: one style for all of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.ticker import PercentFormatter

INK, DIM, GRID = "#1B2430", "#8A94A3", "#E6E9EE"
# Told apart by eyes of every kind, and in gray; in the order of use.
_KINDS = ("#0B5FD0", "#E4720D", "#0A9A74", "#A33EA1", "#C9304B", "#6B7280", "#B8860B", "#1098AD")
# Policies that several figures show have the same color in all of them.
_POLICIES = {"basic": 0, "printed": 1, "default": 2}
_ORDERED = "viridis_r"
_MARKERS = "osD^vPX*"

STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.5,
    "text.color": INK,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    "axes.titleweight": "bold",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.major.size": 3,
    "ytick.major.size": 0,
    "lines.linewidth": 1.8,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "savefig.dpi": 160,
    "figure.facecolor": "white",
    "svg.fonttype": "none",
    # The same figure is the same file.
    "svg.hashsalt": "swarm-mission-stack",
}


def policy_colors(names: Sequence[str]) -> list[str]:
    """Colors for policies by name; those without a color of their own get one that is left."""
    left = [color for number, color in enumerate(_KINDS) if number not in _POLICIES.values()]
    others = [name for name in names if name not in _POLICIES]
    return [_KINDS[_POLICIES[name]] if name in _POLICIES else left[others.index(name) % len(left)] for name in names]


def kind_colors(count: int) -> list[str]:
    """Colors for lines that have names and no order."""
    return [_KINDS[number % len(_KINDS)] for number in range(count)]


def scale_colors(count: int) -> list[Any]:
    """Colors for lines that have an order, such as radii: a scale; two are told apart better by plain kinds."""
    if count < 3:
        return kind_colors(count)
    scale = mpl.colormaps[_ORDERED]
    return [scale(0.12 + 0.88 * number / (count - 1)) for number in range(count)]


def marker(number: int) -> str:
    """The marker of a line's points."""
    return _MARKERS[number % len(_MARKERS)]


def percent_axis(axes: Axes) -> None:
    """Shares from 0 to 1 as percent, all of the range shown."""
    axes.set_ylim(0.0, 1.03)
    axes.set_yticks([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
