"""A mission from above: where agents flew, in the colors of what they did, and where targets went and were lost."""

from __future__ import annotations

from math import inf

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comms.arena import Shape
from comms.status import Activity
from missions.colors import ACTIVITY_INKS, hex_color
from missions.review.figures.over_time import colored_runs
from missions.review.reading import Review
from missions.review.words import agent
from missions.study.style import DIM, GRID, INK, STYLE

_SIDE_IN = 5.4
_NAMED_AGENTS = 30
# Shorter losses, of a target that somebody has again at once, are not marked.
_MARKED_S = 1.0
_BAD = hex_color(ACTIVITY_INKS[Activity.LOST])


def from_above(review: Review) -> Figure:
    """The picture."""
    arena = review.arena
    with mpl.rc_context(STYLE):
        aspect = arena.half_y_m / arena.half_x_m
        figure = Figure(figsize=(_SIDE_IN, _SIDE_IN * min(1.4, max(0.5, aspect)) + 0.5), layout="constrained")
        axes = figure.subplots()
        axes.set_aspect("equal")
        axes.grid(visible=False)
        _edge(axes, review)
        _paths(axes, review)
        for loss in review.losses:
            if not loss.left and (loss.found_after_s or inf) > _MARKED_S:
                axes.plot(*loss.place_m, "x", color=_BAD, markersize=7, markeredgewidth=2, zorder=4)
        axes.set_title("Agents ●, targets ■, losses ×")
        axes.set_xlabel("east, m")
        axes.set_ylabel("north, m")
    return figure


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
    flown = review.snapshots_flown
    if not flown:
        return
    for number in range(review.playback.facts.targets):
        trail = np.array([seen.targets_m[number] for seen in flown])
        axes.plot(*trail.T, color=DIM, linewidth=0.7, zorder=2)
        axes.plot(*trail[-1], "s", color=INK, markersize=3, zorder=6)
    for uid in range(review.playback.facts.agents):
        places = np.array([seen.agents_m[uid] for seen in flown])
        colors = [hex_color(ACTIVITY_INKS[seen.activities[uid]]) for seen in flown[1:]]
        for run, color in colored_runs(places, colors):
            axes.plot(*run.T, color=color, linewidth=1.5, zorder=3)
        axes.plot(*places[-1], "o", color=colors[-1] if colors else INK, markersize=7, zorder=5)
        if review.playback.facts.agents <= _NAMED_AGENTS:
            axes.annotate(agent(uid), places[-1], xytext=(6, 4), textcoords="offset points", size=8, zorder=7)
