"""The figures of a study as PNG and SVG, each with a caption of what the paper says and what was measured.

Lines are means over runs, bands and bars their 95 % intervals; the dim line is what agents standing at random places
would cover. Where policies and something else vary, every policy has a panel of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.patheffects import withStroke

from missions.plan import coverage_floor
from missions.study.metrics import QUANTITIES, Quantity, Window
from missions.study.model import Figure
from missions.study.points import FAULTS, POLICY, Point, matches
from missions.study.results import Results
from missions.study.statistics import estimate, estimates
from missions.study.store import write_whole
from missions.study.style import DIM, STYLE, kind_colors, marker, percent_axis, policy_colors, scale_colors
from missions.study.words import axis_words, point_words, telling_keys

TIME = "time"
_WIDTH_IN, _HEIGHT_IN = 6.4, 4.1
_PANEL_IN = 4.3
_FEW_FLOORS = 2


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a figure: its name, its color and marker, and its points in the order of x."""

    name: str
    color: Any
    marker: str
    points: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Panel:
    """One panel of a figure; without a name it is the only one."""

    name: str
    lines: tuple[Line, ...]


def draw(results: Results, figure: Figure) -> Canvas | None:
    """The figure; None if none of its points was flown."""
    panels = panels_of(results, figure)
    if not panels:
        return None
    with mpl.rc_context(STYLE):
        width = _WIDTH_IN if len(panels) == 1 else _PANEL_IN * len(panels)
        canvas = Canvas(figsize=(width, _HEIGHT_IN), layout="constrained")
        grid = canvas.subplots(1, len(panels), sharey=True, squeeze=False)[0]
        for axes, panel in zip(grid, panels, strict=True):
            _panel(results, figure, axes, panel)
        grid[0].set_ylabel(_y_words(figure))
        canvas.suptitle(figure.title, x=0.01, ha="left", weight="bold", size=12)
        handles, names = _legend(grid)
        if len(names) > 1:
            canvas.legend(handles, names, loc="outside lower center", ncols=_columns(names, width))
    return canvas


def write_figure(results: Results, figure: Figure, folder: Path) -> list[Path]:
    """Write a figure as PNG and SVG; nothing if none of its points was flown."""
    canvas = draw(results, figure)
    if canvas is None:
        return []
    written = []
    with mpl.rc_context(STYLE):
        canvas.draw_without_rendering()
        canvas.set_layout_engine("none")  # once is enough
        # Without the date, the same figure is the same file.
        for ending, metadata in (("png", {}), ("svg", {"Date": None})):
            out = BytesIO()
            canvas.savefig(out, format=ending, metadata=metadata)
            path = folder / f"{figure.name}.{ending}"
            write_whole(path, out.getvalue())
            written.append(path)
    return written


def panels_of(results: Results, figure: Figure) -> list[Panel]:
    """Which points go into which line of which panel."""
    points = [p for p in results.ready.points if matches(p, figure.where)]
    keys = telling_keys(points, but=figure.x)
    others = [key for key in keys if key != POLICY]
    if POLICY not in keys or not others:
        lines = _lines(points, keys, figure)
        return [Panel("", lines)] if lines else []
    policies = dict.fromkeys(dict(point.labels)[POLICY] for point in points)
    return [
        Panel(name, _lines([p for p in points if dict(p.labels)[POLICY] == name], others, figure)) for name in policies
    ]


def _lines(points: Sequence[Point], keys: Sequence[str], figure: Figure) -> tuple[Line, ...]:
    groups: dict[str, list[Point]] = {}
    for point in points:
        groups.setdefault(point_words(point, keys), []).append(point)
    policies = [_policy(group) for group in groups.values()]
    if POLICY in keys or not keys:
        colors = policy_colors(policies)
    else:
        colors = kind_colors(len(groups)) if FAULTS in keys else scale_colors(len(groups))
    lines = []
    for number, (name, group) in enumerate(groups.items()):
        if figure.x != TIME:
            group = sorted(group, key=lambda point: float(point.values[figure.x]))
        lines.append(Line(name or _policy(group), colors[number], marker(number), tuple(group)))
    return tuple(lines)


def _policy(points: Sequence[Point]) -> str:
    return str(dict(points[0].labels)[POLICY])


def _panel(results: Results, figure: Figure, axes: Axes, panel: Panel) -> None:
    quantity = QUANTITIES[figure.y]
    for line in panel.lines:
        if figure.x == TIME:
            _over_time(results, figure, axes, line)
        else:
            _by_key(results, figure, axes, line)
    axes.set_xlabel(figure.x_label or axis_words(figure.x))
    axes.set_title(panel.name)
    if figure.x != TIME:
        axes.set_xticks(sorted({float(point.values[figure.x]) for line in panel.lines for point in line.points}))
    if quantity.is_share:
        percent_axis(axes)
    else:
        axes.set_ylim(bottom=0.0)
    axes.margins(x=0.02)
    _floors(figure, axes, panel)


def _over_time(results: Results, figure: Figure, axes: Axes, line: Line) -> None:
    for point in line.points:
        flown = results.of(point)
        shares = flown.share_by_second()[:, : None if figure.until_s is None else int(figure.until_s)]
        scale = flown.n_targets / flown.n_agents if figure.y == "utilization" else 1.0
        mean, low, high = (column * scale for column in estimates(shares))
        seconds = np.arange(len(mean)) + 0.5
        axes.plot(seconds, mean, color=line.color, label=line.name)
        axes.fill_between(seconds, low, high, color=line.color, alpha=0.16, linewidth=0)
        axes.set_xlim(0, len(mean))


def _by_key(results: Results, figure: Figure, axes: Axes, line: Line) -> None:
    quantity, window = QUANTITIES[figure.y], Window(0.0, figure.until_s)
    told = [estimate(quantity.of(results.of(point), window)) for point in line.points]
    x = [float(point.values[figure.x]) for point in line.points]
    mean, low, high = [e.mean for e in told], [e.low for e in told], [e.high for e in told]
    axes.fill_between(x, low, high, color=line.color, alpha=0.14, linewidth=0)
    axes.vlines(x, low, high, color=line.color, linewidth=1.4)
    axes.plot(x, mean, color=line.color, marker=line.marker, markersize=5.5, label=line.name)


def _floors(figure: Figure, axes: Axes, panel: Panel) -> None:
    """What agents standing at random places would cover."""
    floors_of: dict[tuple[float, ...], Line] = {}
    for line in panel.lines:
        floors = [floor_of(point, figure) for point in line.points]
        known = tuple(round(floor, 6) for floor in floors if floor is not None)
        if known:
            floors_of.setdefault(known, line)
    for known, line in floors_of.items():
        x = list(axes.get_xlim()) if figure.x == TIME else [float(point.values[figure.x]) for point in line.points]
        y = known * 2 if figure.x == TIME else known
        # Where every line has a floor of its own, it is told by the line's color.
        shade = {"color": DIM} if len(floors_of) <= _FEW_FLOORS else {"color": line.color, "alpha": 0.4}
        axes.plot(x, y, linestyle=(0, (4, 3)), linewidth=1.0, zorder=1, **shade)
        if len(floors_of) <= _FEW_FLOORS:
            _note(axes, f"static placement {QUANTITIES[figure.y].shown(known[-1])}", (x[-1], known[-1]))
    if len(floors_of) > _FEW_FLOORS:
        _note(axes, "dashed: static placement", (axes.get_xlim()[1], 0.0))


def _note(axes: Axes, text: str, place: tuple[float, float]) -> None:
    note = axes.annotate(text, place, (-2, 3), textcoords="offset points", ha="right", va="bottom", size=8, color=DIM)
    note.set_path_effects([withStroke(linewidth=2.5, foreground="white")])


def floor_of(point: Point, figure: Figure) -> float | None:
    """The static-placement floor in the figure's unit; None if it has no meaning there."""
    floor = coverage_floor(point.mission)
    if figure.y in ("coverage", "coverage_late", "lowest"):
        return floor
    ratio = point.values.get("ratio")
    return floor * ratio if figure.y == "utilization" and ratio is not None else None


def _y_words(figure: Figure) -> str:
    quantity: Quantity = QUANTITIES[figure.y]
    words = quantity.label if quantity.is_share else f"{quantity.label} ({quantity.unit})"
    return words if figure.x == TIME else f"mean {words}"


def _columns(names: Sequence[str], width_in: float) -> int:
    """How many columns of a legend fit beside each other."""
    each_in = 0.55 + 0.075 * max(map(len, names))
    return max(1, min(len(names), int(width_in / each_in)))


def _legend(grid: Any) -> tuple[list[Any], list[str]]:
    """Every line once, whichever panels it is in."""
    found: dict[str, Any] = {}
    for axes in grid:
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(name, handle)
    return list(found.values()), list(found)
