"""A mission in pictures: coverage, what each agent did and how far targets were from eyes over time; and from above."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from itertools import groupby
from pathlib import Path

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator

from comms.arena import Shape
from comms.status import Activity
from missions.colors import ACTIVITY_COLORS, hex_color
from missions.observation import Observation
from missions.problems import InputError
from missions.review.reading import Review
from missions.review.words import agent, clock, percent
from missions.study.style import DIM, GRID, INK, STYLE, percent_axis

FORMATS = (".png", ".svg")
_WIDTH_IN, _COVERAGE_IN, _LANE_IN, _DISTANCES_IN = 9.0, 1.9, 0.17, 1.7
_MOST_LANES_IN = 4.2
_NAMED_AGENTS = 30
_POINTS = 900  # along time: finer than any screen
_GOOD, _BAD = hex_color(ACTIVITY_COLORS[Activity.FOLLOW]), hex_color(ACTIVITY_COLORS[Activity.LOST])
_STEADY, _OTHER = "#0B5FD0", "#E4720D"

Floats = npt.NDArray[np.float64]


def write_picture(figure: Figure, path: Path) -> None:
    """Write a figure as the file's name says.

    Raises:
        InputError: it says something else than PNG or SVG, or the file cannot be written.
    """
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"--plot: got {path}; allowed: a file that ends with {' or '.join(FORMATS)}")
    try:
        path.write_bytes(as_bytes(figure, path.suffix.lower().removeprefix(".")))
    except OSError as error:
        raise InputError(f"--plot: got {path}; allowed: a file that can be written ({error.strerror})") from error


def as_bytes(figure: Figure, kind: str) -> bytes:
    """A figure as `png` or `svg`; the same figure is the same bytes."""
    out = BytesIO()
    metadata = {"Date": None} if kind == "svg" else {"Software": None}
    with mpl.rc_context(STYLE):
        figure.savefig(out, format=kind, metadata=metadata)
    return out.getvalue()


def over_time(review: Review, *, titled: bool = True) -> Figure:
    """Coverage, lanes of activities, and distances, one below the other."""
    seen = _thinned(review.playback.observations)
    lanes_in = min(_MOST_LANES_IN, 0.5 + _LANE_IN * review.playback.facts.agents)
    heights = (_COVERAGE_IN, lanes_in, _DISTANCES_IN)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(_WIDTH_IN, sum(heights) + 0.9), layout="constrained")
        axes = figure.subplots(3, 1, sharex=True, height_ratios=heights)
        _faults(axes[0], review)
        _coverage(axes[0], review)
        _lanes(axes[1], review)
        _distances(axes[2], review, seen)
        _clock_axis(axes[2], "time since power-on")
        axes[2].set_xlim(seen[0].time_s, seen[-1].time_s)
        if titled:
            figure.suptitle(_title(review), x=0.01, ha="left", weight="bold", size=12)
    return figure


def _title(review: Review) -> str:
    facts, coverage = review.playback.facts, percent(review.report["coverage"])
    who = f"{facts.agents} agents over {facts.targets} targets"
    return f"{facts.mission}, seed {facts.seed}: {who}, coverage {coverage}"


def side_by_side(first: Review, second: Review) -> Figure:
    """Coverage of two missions in one picture, counted from the beginning of MISSION."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(_WIDTH_IN, 3.2), layout="constrained")
        axes = figure.subplots()
        for review, color in ((first, _STEADY), (second, _OTHER)):
            flown = [seen for seen in review.playback.observations if seen.mission_tick is not None]
            began_s = flown[0].time_s if flown else 0.0
            times = [seen.time_s - began_s for seen in flown]
            name = f"{review.playback.path.name}: {percent(review.report['coverage'])}"
            axes.plot(times, [_number(seen.coverage) for seen in flown], color=color, linewidth=0.7, alpha=0.45)
            axes.plot(times, [_number(seen.coverage_mean) for seen in flown], color=color, label=name)
        percent_axis(axes)
        axes.set_title("Coverage: now (thin) and mean so far")
        _clock_axis(axes, "time since the mission began")
        axes.legend(loc="lower right")
    return figure


def from_above(review: Review) -> Figure:
    """Where agents flew, in the colors of what they did, and where targets were lost."""
    arena = review.arena
    with mpl.rc_context(STYLE):
        aspect = arena.half_y_m / arena.half_x_m
        figure = Figure(figsize=(5.4, 5.4 * min(1.4, max(0.5, aspect)) + 0.5), layout="constrained")
        axes = figure.subplots()
        axes.set_aspect("equal")
        axes.grid(visible=False)
        _edge(axes, review)
        _paths(axes, review)
        for loss in review.losses:
            place = review.at(loss.time_s).targets[loss.target]
            axes.plot(place.x_m, place.y_m, "x", color=_BAD, markersize=7, markeredgewidth=2, zorder=4)
        axes.set_title("Agents ●, targets ■, losses ×")
        axes.set_xlabel("east, m")
        axes.set_ylabel("north, m")
    return figure


def _clock_axis(axes: Axes, words: str) -> None:
    axes.xaxis.set_major_locator(MaxNLocator(9, steps=[1, 1.5, 3, 6]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda time_s, _: clock(time_s)[:-2]))
    axes.set_xlabel(f"{words}, minutes : seconds")


def _thinned(observations: Sequence[Observation]) -> Sequence[Observation]:
    return observations[:: max(1, len(observations) // _POINTS)]


def _number(share: float | None) -> float:
    return np.nan if share is None else share


def _faults(axes: Axes, review: Review) -> None:
    """A gray stretch for each fault on purpose, with its name."""
    start_s, flown_s = review.began_s or 0.0, review.report["duration_s"]
    for fault in review.report["injected"]:
        if fault["at_s"] < flown_s:
            until_s = min(flown_s, fault["until_s"] or fault["at_s"])
            axes.axvspan(start_s + fault["at_s"], start_s + until_s, color=DIM, alpha=0.22, linewidth=0.8)
            axes.text(start_s + fault["at_s"], 0.1, f" {fault['what']}", size=8, color=INK, clip_on=True)


def _coverage(axes: Axes, review: Review) -> None:
    flown = [seen for seen in review.playback.observations if seen.mission_tick is not None]
    times = [seen.time_s for seen in flown]
    now = [_number(seen.coverage) for seen in flown]
    axes.fill_between(times, now, step="post", color=_GOOD, alpha=0.25, linewidth=0)
    axes.step(times, now, where="post", color=_GOOD, linewidth=0.9, label="seen now")
    axes.plot(times, [_number(seen.coverage_mean) for seen in flown], color=INK, label="mean so far")
    floor = review.report["coverage_floor"]
    if floor is not None:
        axes.axhline(floor, color=DIM, linewidth=1.0, linestyle=(0, (4, 3)), label="random, standing still")
    for number, loss in enumerate(review.losses):
        axes.axvline(loss.time_s, ymax=0.06, color=_BAD, linewidth=1.6, label=None if number else "a target is lost")
    percent_axis(axes)
    axes.set_title("Coverage")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=4, fontsize=8)


def _lanes(axes: Axes, review: Review) -> None:
    """A lane for each agent, A0 on top, and what the colors mean."""
    observations, met = review.playback.observations, set[Activity]()
    n_agents, end_s = review.playback.facts.agents, observations[-1].time_s
    for uid in range(n_agents):
        for activity, run in groupby(observations, key=lambda seen: seen.statuses[uid].activity):
            began_s = next(run).time_s
            met.add(activity)
            # Each piece reaches to the end, and the next one covers it: no gaps.
            axes.barh(uid, end_s - began_s, left=began_s, height=0.86, color=hex_color(ACTIVITY_COLORS[activity]))
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


def _distances(axes: Axes, review: Review, seen: Sequence[Observation]) -> None:
    """How far each target is from the nearest agent: green in sight, red out of it."""
    times = np.array([one.time_s for one in seen])
    for number in range(review.playback.facts.targets):
        away = np.array([_nearest_m(one, number) for one in seen])
        points = np.column_stack((times, away))
        pieces = np.stack((points[:-1], points[1:]), axis=1)
        outside = [not one.targets[number].seen for one in seen[:-1]]
        colors = [_BAD if out else _GOOD for out in outside]
        axes.add_collection(LineCollection(list(pieces), colors=colors, linewidths=1.0, alpha=0.8))
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
    axes.autoscale(axis="y")
    axes.set_ylim(bottom=0.0)
    axes.set_title("From each target to the nearest agent, m")


def _nearest_m(seen: Observation, number: int) -> float:
    target = seen.targets[number]
    if not target.present or seen.mission_tick is None:
        return np.nan
    places = np.array([truth.position_m[:2] for truth in seen.truths])
    return float(np.hypot(*(places - (target.x_m, target.y_m)).T).min())


def _edge(axes: Axes, review: Review) -> None:
    arena = review.arena
    if arena.shape == Shape.DISC:
        turn = np.linspace(0.0, 2 * np.pi, 181)
        x, y = arena.half_x_m * np.cos(turn), arena.half_y_m * np.sin(turn)
    else:
        x, y = np.array([-1, 1, 1, -1, -1]) * arena.half_x_m, np.array([-1, -1, 1, 1, -1]) * arena.half_y_m
    axes.fill(x, y, color=GRID, alpha=0.5, zorder=0)
    axes.plot(x, y, color=DIM, linewidth=1.2, zorder=1)


def _paths(axes: Axes, review: Review) -> None:
    flown = _thinned([seen for seen in review.playback.observations if seen.mission_tick is not None])
    if not flown:
        return
    for number in range(review.playback.facts.targets):
        trail = np.array([(t.x_m, t.y_m) if (t := seen.targets[number]).present else (np.nan,) * 2 for seen in flown])
        axes.plot(*trail.T, color=DIM, linewidth=0.7, zorder=2)
        axes.plot(*trail[-1], "s", color=INK, markersize=3, zorder=6)
    for uid in range(review.playback.facts.agents):
        places = np.array([seen.truths[uid].position_m[:2] for seen in flown])
        pieces = np.stack((places[:-1], places[1:]), axis=1)
        colors = [hex_color(ACTIVITY_COLORS[seen.statuses[uid].activity]) for seen in flown[1:]]
        axes.add_collection(LineCollection(list(pieces), colors=colors, linewidths=1.5, zorder=3))
        axes.plot(*places[-1], "o", color=colors[-1] if colors else INK, markersize=7, zorder=5)
        if review.playback.facts.agents <= _NAMED_AGENTS:
            axes.annotate(agent(uid), places[-1], xytext=(6, 4), textcoords="offset points", size=8, zorder=7)
    axes.autoscale()
