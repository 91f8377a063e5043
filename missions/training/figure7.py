"""Figure 7: what the net for two tags says, as a cloud of points in its three inputs, colored by the time of loss."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure as Canvas

from missions.study.store import write_whole
from missions.study.style import STYLE
from missions.training.weights import BUNDLED, read_weights
from swarm_agent.bcmommt.net import TAUGHT_S, Net, forward, pair_inputs

NAME = "figure-7"
_STEPS = 20
_LABELS = ("V1: agent to tag 1, over $r_s$", "V2: agent to tag 2, over $r_s$", "V3: tag 1 to tag 2, over $2\\,r_s$")


def points(net: Net, steps: int = _STEPS) -> list[tuple[float, float, float, float]]:
    """(V1, V2, V3, seconds until the first loss) on a grid of all that can be: the three are sides of a triangle.

    Args:
        steps: points along each side of the unit cube, less one.
    """
    found = []
    for i in range(steps + 1):
        for j in range(steps + 1):
            for k in range(abs(i - j), min(i + j, 2 * steps) + 1, 2):
                v1, v2, v3 = i / steps, j / steps, k / (2 * steps)
                found.append((v1, v2, v3, TAUGHT_S * forward(net, pair_inputs(v1, v2, 2.0 * v3, 1.0))))
    return found


def draw(net: Net) -> Canvas:
    """The figure: black is 20 s, bright an immediate loss, as in the paper."""
    v1, v2, v3, seconds = np.array(points(net)).T
    with mpl.rc_context(STYLE):
        canvas = Canvas(figsize=(6.4, 5.2), layout="constrained")
        axes = canvas.add_subplot(projection="3d")
        cloud = axes.scatter(v1, v2, v3, c=seconds, cmap="inferno_r", vmin=0.0, vmax=TAUGHT_S, s=9, depthshade=False)
        axes.set(xlabel=_LABELS[0], ylabel=_LABELS[1], zlabel=_LABELS[2], xlim=(0, 1), ylim=(0, 1), zlim=(0, 1))
        axes.view_init(elev=22, azim=-62)
        axes.set_box_aspect((1.0, 1.0, 1.0), zoom=0.86)
        canvas.colorbar(cloud, ax=axes, shrink=0.65, label="time until the first loss (s)")
        canvas.suptitle("The learned predictor for two tags", x=0.01, ha="left", weight="bold", size=12)
    return canvas


def write(folder: Path, net: Net | None = None) -> list[Path]:
    """Write figure 7 as PNG and SVG into a folder; without a net, that of the bundled weights."""
    canvas = draw(net or read_weights(BUNDLED).pair.net)
    written = []
    with mpl.rc_context(STYLE):
        for ending, metadata in (("png", {}), ("svg", {"Date": None})):
            out = BytesIO()
            canvas.savefig(out, format=ending, metadata=metadata)
            path = folder / f"{NAME}.{ending}"
            write_whole(path, out.getvalue())
            written.append(path)
    return written
