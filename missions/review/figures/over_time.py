"""A mission over time: coverage and what struck it, what each agent did, how far targets were from the nearest eyes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from operator import itemgetter

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator

from comms.status import Activity
from missions.colors import ACTIVITY_COLORS, ACTIVITY_INKS, hex_color
from missions.review.figures.snapshots import POINTS, Snapshot
from missions.review.reading import Review
from missions.review.words import agent, clock, percent
from missions.study.style import DIM, INK, STYLE, percent_axis

_WIDTH_IN, _COVERAGE_IN, _LANE_IN, _DISTANCES_IN = 9.0, 1.9, 0.17, 1.7
_MOST_LANES_IN = 4.2
_FAULT_IN = 0.16
_HALF_LANE = 0.43
_LETTER = 0.0085  # of the width of the picture
_GREEN = hex_color(ACTIVITY_COLORS[Activity.FOLLOW])
_GOOD, _BAD = hex_color(ACTIVITY_INKS[Activity.FOLLOW]), hex_color(ACTIVITY_INKS[Activity.LOST])

Floats = npt.NDArray[np.float64]


def over_time(review: Review, *, titled: bool = True) -> Figure:
    """Faults on purpose, coverage, lanes of activities, and distances, one below the other."""
    first_s = review.series.time_s[0]
    shown_s = first_s, max(review.ended_s, first_s + review.playback.facts.tick_s)
    lanes_in = min(_MOST_LANES_IN, 0.5 + _LANE_IN * review.playback.facts.agents)
    faults = list(_stacked(review, shown_s))
    faults_in = 0.1 + _FAULT_IN * (1 + max((row for *_, row in faults), default=-1))
    heights = [faults_in, _COVERAGE_IN, lanes_in, _DISTANCES_IN] if faults else [_COVERAGE_IN, lanes_in, _DISTANCES_IN]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(_WIDTH_IN, sum(heights) + 0.9 + 0.25 * bool(faults)), layout="constrained")
        axes = list(figure.subplots(len(heights), 1, sharex=True, height_ratios=heights))
        if faults:
            _faults(axes.pop(0), faults, axes)
        _coverage(axes[0], review)
        _lanes(axes[1], review)
        _distances(axes[2], review)
        clock_axis(axes[2], "time since power-on")
        axes[2].set_xlim(*shown_s)
        if titled:
            figure.suptitle(_title(review), x=0.01, ha="left", weight="bold", size=12)
    return figure


def clock_axis(axes: Axes, words: str) -> None:
    """Time along the bottom, in minutes and seconds."""
    axes.xaxis.set_major_locator(MaxNLocator(9, steps=[1, 1.5, 3, 6]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda time_s, _: clock(time_s)[:-2]))
    axes.set_xlabel(f"{words}, minutes : seconds")


def colored_runs(points: Floats, colors: Sequence[str]) -> Iterator[tuple[Floats, str]]:
    """A line through (P, 2) points in as few pieces as it has runs of one color; `colors` are of its P - 1 steps."""
    start = 0
    for color, run in groupby(colors):
        end = start + len(list(run))
        yield points[start : end + 1], color
        start = end


def _title(review: Review) -> str:
    facts, coverage = review.playback.facts, percent(review.report["coverage"])
    who = f"{facts.agents} agents over {facts.targets} targets"
    return f"{facts.mission}, seed {facts.seed}: {who}, coverage {coverage}"


def _stacked(review: Review, shown_s: tuple[float, float]) -> Iterator[tuple[str, float, float, int]]:
    """Each fault on purpose that struck: name, from, until, and a row in which its name hides no other's."""
    start_s, flown_s = review.began_s or 0.0, review.report["duration_s"]
    letter_s = _LETTER * (shown_s[1] - shown_s[0])
    free_s: list[float] = []  # of each row
    for fault in review.report["injected"]:
        if fault["at_s"] >= flown_s:
            continue
        name = f"{fault['what']}, {fault['whom']}"
        # One that is not said to end lasts as long as the mission.
        from_s, until_s = (start_s + min(flown_s, time_s) for time_s in (fault["at_s"], fault["until_s"] or flown_s))
        row = next((row for row, free in enumerate(free_s) if free <= from_s), len(free_s))
        free_s[row : row + 1] = [max(until_s, from_s + letter_s * len(name))]
        yield name, from_s, until_s, row


def _faults(axes: Axes, faults: Sequence[tuple[str, float, float, int]], below: Sequence[Axes]) -> None:
    """A bar for each fault with its name, and its stretch in gray through all that is below."""
    for name, from_s, until_s, row in faults:
        axes.barh(row, until_s - from_s, left=from_s, height=0.84, color=DIM, alpha=0.45, linewidth=0)
        axes.text(from_s, row, f" {name}", size=8, color=INK, va="center", clip_on=False)
        for other in below:
            if other is not below[1]:
                other.axvspan(from_s, until_s, color=DIM, alpha=0.16, linewidth=0)
    axes.set_ylim(max(row for *_, row in faults) + 0.6, -0.6)
    axes.set_yticks([])
    axes.grid(visible=False)
    axes.spines[["left", "bottom"]].set_visible(False)
    axes.tick_params(length=0)
    axes.set_title("Faults on purpose")


def _coverage(axes: Axes, review: Review) -> None:
    series = review.series
    flown = list(zip(series.flown_s, series.coverage, series.coverage_mean, strict=True))
    steps = [next(run) for _, run in groupby(flown, key=itemgetter(1))] + flown[-1:]
    times, now = [time_s for time_s, *_ in steps], [share for _, share, _ in steps]
    axes.fill_between(times, now, step="post", color=_GREEN, alpha=0.25, linewidth=0)
    axes.step(times, now, where="post", color=_GOOD, linewidth=0.9, label="seen now")
    some = flown[:: max(1, len(flown) // POINTS)] + flown[-1:]
    axes.plot([time_s for time_s, *_ in some], [mean for *_, mean in some], color=INK, label="mean so far")
    floor = review.report["coverage_floor"]
    if floor is not None:
        axes.axhline(floor, color=DIM, linewidth=1.0, linestyle=(0, (4, 3)), label="random, standing still")
    lost_s = [loss.time_s for loss in review.losses if not loss.left]
    if lost_s:
        axes.vlines(lost_s, 0.0, 0.07, color=_BAD, linewidth=1.6, label="a target is lost")
    percent_axis(axes)
    axes.set_title("Coverage")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=4, fontsize=8)


def _lanes(axes: Axes, review: Review) -> None:
    """A lane for each agent, A0 on top, and what the colors mean."""
    n_agents, met = review.playback.facts.agents, set[Activity]()
    boxes, colors = [], []
    for uid, starts in enumerate(review.lanes.of):
        ends_s = [*(time_s for time_s, _ in starts[1:]), review.ended_s]
        for (from_s, activity), until_s in zip(starts, ends_s, strict=True):
            low, high = uid - _HALF_LANE, uid + _HALF_LANE
            boxes.append(((from_s, low), (from_s, high), (until_s, high), (until_s, low)))
            colors.append(hex_color(ACTIVITY_COLORS[activity]))
            met.add(activity)
    axes.add_collection(PolyCollection(boxes, facecolors=colors, linewidths=0, antialiased=False))
    axes.set_ylim(n_agents - 0.4, -0.6)
    every = max(1, n_agents // 12)
    axes.set_yticks(range(0, n_agents, every), [agent(uid) for uid in range(0, n_agents, every)])
    axes.grid(visible=False)
    axes.set_title("What each agent does")
    handles = [
        Patch(color=hex_color(color), label=activity.value)
        for activity, color in ACTIVITY_COLORS.items()
        if activity in met
    ]
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=len(handles), fontsize=8)


def _distances(axes: Axes, review: Review) -> None:
    """How far each target is from the nearest agent: red from one point to the next if nobody saw it in between."""
    shown = review.snapshots
    times = np.array([one.time_s for one in shown])
    n_targets = review.playback.facts.targets
    lost = np.array([one.unseen for one in shown[:-1]]).reshape(len(shown) - 1, n_targets)
    for target in range(n_targets):
        away = np.array([_nearest_m(one, target) for one in shown])
        colors = [_BAD if out else _GOOD for out in lost[:, target]]
        for run, color in colored_runs(np.column_stack((times, away)), colors):
            axes.plot(*run.T, color=color, linewidth=1.0, alpha=0.8)
    axes.axhline(review.sensing_range_m, color=INK, linewidth=1.0, linestyle=(0, (4, 3)))
    axes.annotate(
        "sensing range",
        (1.0, review.sensing_range_m),
        xycoords=("axes fraction", "data"),
        xytext=(0, 2),
        textcoords="offset points",
        ha="right",
        va="bottom",
        size=8,
    )
    axes.set_ylim(bottom=0.0)
    axes.set_title("From each target to the nearest agent, m (red: nobody sees it)")


def _nearest_m(one: Snapshot, target: int) -> float:
    if not one.on_duty:
        return np.nan
    return float(np.hypot(*(one.agents_m - one.targets_m[target]).T).min())
