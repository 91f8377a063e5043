"""Coverage of two missions in one picture."""

from __future__ import annotations

import matplotlib as mpl
from matplotlib.figure import Figure

from missions.review.figures.over_time import clock_axis, number
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
            flown = [seen for seen in review.playback.observations if seen.mission_tick is not None]
            began_s = flown[0].time_s if flown else 0.0
            times = [seen.time_s - began_s for seen in flown]
            name = f"{review.playback.path.name}: {percent(review.report['coverage'])}"
            axes.plot(times, [number(seen.coverage) for seen in flown], color=color, linewidth=0.7, alpha=0.45)
            axes.plot(times, [number(seen.coverage_mean) for seen in flown], color=color, label=name)
        percent_axis(axes)
        axes.set_title("Coverage: now (thin) and mean so far")
        clock_axis(axes, "time since the mission began")
        axes.legend(loc="lower right")
    return figure
