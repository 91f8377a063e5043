"""The text beside a figure: what the paper says, what was measured, and under which conditions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from missions.mission import MovingTargets
from missions.plan import coverage_floor
from missions.problems import shown
from missions.study.claims import shown_estimate
from missions.study.figures import TIME, Line, panels_of
from missions.study.metrics import QUANTITIES, Window
from missions.study.model import Figure
from missions.study.points import POLICY, Point
from missions.study.results import Results
from missions.study.statistics import estimate


def caption(results: Results, figure: Figure) -> str:
    """The caption as plain text."""
    lines = [figure.title or figure.name, ""]
    if figure.paper:
        lines += [f"The paper: {figure.paper.strip()}", ""]
    lines += ["Measured:"]
    shown_points: list[Point] = []
    for panel in panels_of(results, figure):
        for line in panel.lines:
            name = f"{panel.name}, {line.name}" if panel.name else line.name
            lines += [f"- {name}: {told}" for told in _measured(results, figure, line)]
            shown_points += line.points
    return "\n".join([*lines, "", *conditions(results, shown_points)]) + "\n"


def conditions(results: Results, points: Sequence[Point]) -> list[str]:
    """How the points were flown, in a few lines."""
    if not points:
        return ["Nothing was flown."]
    mission, seeds = points[0].mission, results.ready.seeds
    floors = sorted({round(coverage_floor(point.mission), 6) for point in points})
    floor = " to ".join(f"{100 * floor:.1f} %" for floor in dict.fromkeys((floors[0], floors[-1])))
    targets = mission.targets
    speeds = [f"agents {shown(mission.agents.speed_m_s)} m/s"]
    if isinstance(targets, MovingTargets):
        speeds.append(f"{targets.motion} targets {shown(targets.speed_m_s)} m/s")
    return [
        f"Mean of {len(seeds)} runs a point (seeds {seeds[0]} to {seeds[-1]}, the same for every point); intervals: "
        "95 %, Student's t over runs.",
        f"{', '.join(speeds)}, sensing {shown(mission.agents.sensing.range_m)} m, radio "
        f"{shown(mission.radio.range_m)} m, tick {shown(mission.tick_s)} s; ideal vehicles and radio.",
        f"Static placement at random places would cover {floor}.",
    ]


def _measured(results: Results, figure: Figure, line: Line) -> Iterator[str]:
    quantity = QUANTITIES[figure.y]
    whole = Window(0.0, figure.until_s)

    def told(point: Point, window: Window) -> str:
        return shown_estimate(quantity, estimate(quantity.of(results.of(point), window)))

    if figure.x != TIME:
        parts = [f"{shown(point.values[figure.x])}: {told(point, whole)}" for point in line.points]
        yield f"{quantity.label} at {figure.x_label or figure.x} " + "; ".join(parts)
        return
    for point in line.points:
        curve = np.nanmean(results.of(point).share_by_second(), axis=0)
        curve = curve[: None if figure.until_s is None else int(figure.until_s)]
        until_s = float(len(curve))
        last = Window(until_s * 3 // 4, until_s)
        parts = [
            f"{told(point, whole)} over the whole time",
            f"{told(point, last)} in the last quarter",
        ]
        if figure.y == "coverage":
            parts.append(
                f"{100 * curve[0]:.1f} % in the first second, lowest {100 * curve.min():.1f} % at {curve.argmin()} s"
            )
        yield "; ".join(parts)


def policy_words(points: Sequence[Point]) -> list[str]:
    """What each policy of a study is, where it differs from the mission's defaults."""
    told: dict[str, str] = {}
    for point in points:
        policy = point.mission.policy
        plain = type(policy)()
        changes = {key: value for key, value in policy.model_dump(mode="json").items() if getattr(plain, key) != value}
        words = ", ".join(
            f"{key}: {value if isinstance(value, str) else shown(value)}" for key, value in changes.items()
        )
        told.setdefault(str(dict(point.labels)[POLICY]), words or "the mission's defaults")
    return [f"`{name}`: {words}" for name, words in told.items()]
