"""Coverage of two missions in one picture."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from missions.review.figures.over_time import clock_axis
from missions.review.reading import Review
from missions.review.words import percent
from missions.study.style import STYLE, percent_axis

_SIZE_IN = (9.0, 3.2)
_FIRST, _SECOND = "#0B5FD0", "#E4720D"


def side_by_side(first: Review, second: Review) -> Figure:
    """Coverage now and so far, counted from the beginning of MISSION."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=_SIZE_IN, layout="constrained")
        axes = figure.subplots()
        for review, color in ((first, _FIRST), (second, _SECOND)):
            series = review.series
            times = np.asarray(series.flown_s) - (review.began_s or 0.0)
            name = f"{review.playback.path.name}: {percent(review.report['coverage'])}"
            axes.plot(times, series.coverage, color=color, linewidth=0.7, alpha=0.45)
            axes.plot(times, series.coverage_mean, color=color, label=name)
        percent_axis(axes)
        axes.set_title("Coverage: now (thin) and mean so far")
        clock_axis(axes, "time since the mission began")
        axes.legend(loc="lower right")
    return figure
