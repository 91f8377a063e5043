"""A study that has been flown: its points with their runs, and the tables that are written of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from types import MappingProxyType
from typing import Any

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet

from missions.study.flown import COUNTS, Flown
from missions.study.load import ReadyStudy
from missions.study.metrics import ALL, QUANTITIES
from missions.study.points import Point
from missions.study.statistics import estimate, estimates
from missions.study.store import write_whole

Columns = dict[str, list[Any]]
PER_RUN = ("coverage", "coverage_late", "utilization", *COUNTS)


@dataclass(frozen=True, slots=True)
class Results:
    """The runs of every point of a study."""

    ready: ReadyStudy
    flown: Mapping[str, Flown]

    def of(self, point: Point) -> Flown:
        """A point's runs, one for each of the study's seeds that has been flown, in ascending order."""
        return self.flown[point.digest].of_seeds(self.ready.seeds)

    @property
    def missing(self) -> int:
        """How many runs of the study have not been flown."""
        wanted = len(self.ready.seeds)
        return sum(
            wanted - (len(self.of(point).seeds) if point.digest in self.flown else 0) for point in self.ready.points
        )


def runs_table(results: Results) -> Columns:
    """One row for every run."""
    columns: Columns = {}
    for point in results.ready.points:
        flown = results.of(point)
        rows = {"seed": flown.seeds, **{name: QUANTITIES[name].of(flown, ALL) for name in PER_RUN}}
        integers = ("seed", *COUNTS)
        values = {
            name: [int(value) if name in integers else number(value) for value in column]
            for name, column in rows.items()
        }
        _extend(columns, point, values, len(flown.seeds))
    return columns


def points_table(results: Results) -> Columns:
    """One row for every point and number: its mean, and the 95 % interval (Student's t over runs)."""
    columns: Columns = {}
    for point in results.ready.points:
        flown = results.of(point)
        told = [(name, estimate(quantity.of(flown, ALL))) for name, quantity in QUANTITIES.items()]
        values: Columns = {
            "metric": [name for name, _ in told],
            "mean": [number(e.mean) for _, e in told],
            "low": [number(e.low) for _, e in told],
            "high": [number(e.high) for _, e in told],
            "runs": [e.runs for _, e in told],
        }
        _extend(columns, point, values, len(told))
    return columns


def over_time_table(results: Results) -> Columns:
    """One row for every point and second: mean coverage in that second, and its 95 % interval."""
    columns: Columns = {}
    for point in results.ready.points:
        shares = results.of(point).share_by_second()
        mean, low, high = estimates(shares)
        values: Columns = {
            "second": list(range(shares.shape[1])),
            "coverage": [number(value) for value in mean],
            "low": [number(value) for value in low],
            "high": [number(value) for value in high],
        }
        _extend(columns, point, values, shares.shape[1])
    return columns


TABLES = {"runs": runs_table, "points": points_table, "over_time": over_time_table}


def write_tables(results: Results, folder: Path, more: Mapping[str, Columns] = MappingProxyType({})) -> list[Path]:
    """Write every table, and `more`, as CSV and as Parquet; none that is empty."""
    written = []
    for name, columns in {**{name: make(results) for name, make in TABLES.items()}, **more}.items():
        if not columns:
            continue
        table = pa.table(columns)
        for ending, write in (("csv", pyarrow.csv.write_csv), ("parquet", pyarrow.parquet.write_table)):
            out = BytesIO()
            write(table, out)
            path = folder / f"{name}.{ending}"
            write_whole(path, out.getvalue())
            written.append(path)
    return written


def _extend(columns: Columns, point: Point, values: Columns, rows: int) -> None:
    told: Columns = {"point": [point.number] * rows}
    told |= {key: [_plain(value)] * rows for key, value in point.labels}
    for name, column in {**told, **values}.items():
        columns.setdefault(name, []).extend(column)


def _plain(value: Any) -> Any:
    """A swept value as a table may hold it: sections and lists as text."""
    return value if isinstance(value, bool | int | float | str) or value is None else str(value)


def number(value: float) -> float | None:
    """None for what is no number, so that no table has NaN or infinity in it."""
    return round(float(value), 9) if abs(value) < float("inf") else None
