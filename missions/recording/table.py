"""The rows of a recording, as plain lists in the order of ticks."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
import pyarrow as pa
from pyarrow.compute import is_valid
from rerun.chunk import RrdReader

_ROW_ID = "rerun.controls.RowId"

T = TypeVar("T")


def held(at: Sequence[int], rows: Sequence[T], ticks: Iterable[int], before: T) -> list[T]:
    """For every tick the latest of `rows`, which were recorded `at` ticks in rising order."""
    latest = (bisect_right(at, tick) for tick in ticks)
    return [rows[count - 1] if count else before for count in latest]


class Table:
    """The rows of a recording by entity and component, in the order of ticks."""

    def __init__(self, readers: Iterable[RrdReader], paths: Sequence[str]) -> None:
        self._batches: dict[str, list[pa.RecordBatch]] = {}
        for chunk in chain.from_iterable(reader.stream().filter(content=list(paths)).to_chunks() for reader in readers):
            self._batches.setdefault(str(chunk.entity_path), []).append(pa.record_batch(chunk.to_record_batch()))

    def statics(self, path: str) -> Mapping[str, Any]:
        """The single values of an entity that hold at all times."""
        found = {}
        for batch in self._batches.get(path, ()):
            for name in batch.schema.names:
                if name != _ROW_ID and (values := batch.column(name)[0].as_py()):
                    found[name] = values[0]
        return found

    def rows(self, path: str, component: str) -> tuple[list[int], list[list[Any]]]:
        """Ticks, and the list that was recorded at each of them; two empty lists when there is nothing."""
        batches = [batch for batch in self._batches.get(path, ()) if {component, "tick"} <= {*batch.schema.names}]
        if not batches:
            return [], []
        table = pa.Table.from_batches([batch.select(["tick", _ROW_ID, component]) for batch in batches])
        table = table.sort_by([("tick", "ascending"), (_ROW_ID, "ascending")])
        table = table.filter(is_valid(table.column(component)))
        return table.column("tick").to_pylist(), table.column(component).to_pylist()

    def held(self, path: str, component: str, ticks: Sequence[int], before: list[Any]) -> list[list[Any]]:
        """The latest list at each of `ticks`."""
        return held(*self.rows(path, component), ticks, before)

    def places(self, path: str, component: str, ticks: Sequence[int], count: int) -> npt.NDArray[np.float64]:
        """(K, count, 3): the latest places at each of `ticks`."""
        at, rows = self.rows(path, component)
        latest = held(at, rows, ticks, [[0.0, 0.0, 0.0]] * count)
        return np.array(latest, dtype=np.float64).reshape(len(ticks), count, 3)
