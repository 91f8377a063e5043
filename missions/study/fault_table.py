"""What faults did: when they were noticed, and what was seen before, meanwhile and after, beside runs without them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from missions.faults.costs import WINDOW_S
from missions.faults.words import words
from missions.mission.faults import AnyFault, LastingFault
from missions.study.flown import Flown
from missions.study.points import FAULTS, Point, labels_but
from missions.study.results import Columns, Results, number
from missions.study.statistics import Estimate, estimate

Floats = npt.NDArray[np.float64]
WINDOWS = ("before", "during", "after")


@dataclass(frozen=True, slots=True)
class FaultRow:
    """One fault of one point, over its runs.

    Attributes:
        noticed: share of runs in which somebody noticed. noticed_s: median time until then; NaN if nobody ever did.
        coverage: by window. cost: coverage of the same runs without faults minus this, by window; none if they were
            not flown.
    """

    point: Point
    fault: AnyFault
    noticed: float
    noticed_s: float
    coverage: dict[str, Estimate]
    cost: dict[str, Estimate]


def fault_rows(results: Results) -> Iterator[FaultRow]:
    """Every fault of every point that has some."""
    for point in results.ready.points:
        flown = results.of(point)
        if flown.noticed_s is None:
            continue
        calm = _calm(results, point)
        for place, fault in enumerate(point.mission.faults):
            after_s = flown.noticed_s[:, place]
            found = after_s[~np.isnan(after_s)]
            shares = {name: _share(flown, *window) for name, window in _windows(fault).items()}
            without = {} if calm is None else {name: _share(calm, *window) for name, window in _windows(fault).items()}
            yield FaultRow(
                point=point,
                fault=fault,
                noticed=len(found) / len(after_s),
                noticed_s=float(np.median(found)) if len(found) else float("nan"),
                coverage={name: estimate(share) for name, share in shares.items()},
                cost={name: estimate(share - shares[name]) for name, share in without.items()},
            )


def faults_table(results: Results) -> Columns:
    """One row for every fault of every point: `cost_*` are coverages lost against the same seeds without faults."""
    columns: Columns = {}
    for row in fault_rows(results):
        told = {
            "point": row.point.number,
            **{key: str(value) for key, value in row.point.labels},
            "fault": words(row.fault),
            "at_s": row.fault.at_s,
            "noticed": number(row.noticed),
            "noticed_after_s": number(row.noticed_s),
            **{name: number(row.coverage[name].mean) for name in WINDOWS},
        }
        for name, cost in row.cost.items():
            told |= {f"cost_{name}": number(cost.mean), f"cost_{name}_low": number(cost.low)}
            told[f"cost_{name}_high"] = number(cost.high)
        for key, value in told.items():
            columns.setdefault(key, []).append(value)
    return columns


def faults_page(results: Results) -> list[str]:
    """The same as a Markdown table; nothing where nothing went wrong."""
    rows = list(fault_rows(results))
    if not rows:
        return []
    lines = [
        "## Faults",
        "",
        f"Coverage in the {WINDOW_S:g} s before a fault, while it lasts (for {WINDOW_S:g} s, if it is over at once or "
        f"never) and in the {WINDOW_S:g} s after that. In brackets: the difference to the same seconds of the same "
        "seeds without faults, in points, with its 95 % interval.",
        "",
        "| What | Fault | Noticed | Before | Meanwhile | Afterwards |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        name = str(dict(row.point.labels).get(FAULTS, row.point.number))
        cells = [name, words(row.fault), _noticed(row), *(_coverage(row, window) for window in WINDOWS)]
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return [*lines, ""]


def _noticed(row: FaultRow) -> str:
    return "never" if not row.noticed else f"after {row.noticed_s:.1f} s, in {row.noticed:.0%} of runs"


def _coverage(row: FaultRow, window: str) -> str:
    share = row.coverage[window].mean
    if np.isnan(share):
        return "none"
    cost = row.cost.get(window)
    if cost is None:
        return f"{100 * share:.1f} %"
    spread = f" ± {100 * cost.half:.1f}" if np.isfinite(cost.half) else ""
    return f"{100 * share:.1f} % ({-100 * cost.mean + 0.0:.1f}{spread})"


def _windows(fault: AnyFault) -> dict[str, tuple[float, float]]:
    """Seconds since the mission began: before it, while it lasts, after it."""
    lasts = fault.for_s if isinstance(fault, LastingFault) else None
    end_s = fault.at_s + (WINDOW_S if lasts is None else lasts)
    return {
        "before": (max(0.0, fault.at_s - WINDOW_S), fault.at_s),
        "during": (fault.at_s, end_s),
        "after": (end_s, end_s + WINDOW_S),
    }


def _share(flown: Flown, from_s: float, until_s: float) -> Floats:
    if until_s <= from_s or from_s >= flown.seen.shape[1]:
        return np.full(len(flown.seeds), np.nan)
    return flown.share(from_s=from_s, until_s=until_s)


def _calm(results: Results, point: Point) -> Flown | None:
    """The runs of the point that differs in its faults alone, having none."""
    for other in results.ready.points:
        if not other.mission.faults and labels_but(other, FAULTS) == labels_but(point, FAULTS):
            return results.of(other)
    return None
