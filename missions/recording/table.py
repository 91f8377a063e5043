"""The rows of one file of a recording, in the order of ticks, read as they are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa
import pyarrow.compute as pc
from rerun.chunk import RrdReader

MISSION = "/__properties/mission"
_ROW_ID, _TICK, _TIME = "rerun.controls.RowId", "tick", "mission_time"
# So many rows are lists at a time; the others are as they lie in the file, which takes a fraction of the memory.
_SLICE = 32
_KEYS = {_TICK: pa.int64(), _TIME: pa.duration("ns"), _ROW_ID: pa.binary(16)}
_POINT = pa.list_(pa.field("item", pa.float32(), nullable=False), 3)

Floats = npt.NDArray[np.float32]
Row = tuple[int, tuple[list[Any], ...]]


class Table:
    """The rows of a file by entity and component.

    Attributes:
        damaged: chunks and rows that were left out: they are not of the type they should be, or their tick is not of
            their time.
    """

    def __init__(self, reader: RrdReader, paths: Sequence[str]) -> None:
        self._batches: dict[str, list[pa.RecordBatch]] = {}
        self.damaged = 0
        for chunk in reader.stream().filter(content=list(paths)):
            try:
                batch = pa.record_batch(chunk.to_record_batch())
                batch.validate(full=True)
            except (pa.ArrowException, RuntimeError, ValueError, TypeError):
                self.damaged += 1
            else:
                self._batches.setdefault(str(chunk.entity_path), []).append(batch)
        self._tick_s = self.statics(MISSION).get("tick_s")

    def statics(self, path: str) -> Mapping[str, Any]:
        """The single values of an entity that hold at all times."""
        found = {}
        for batch in self._batches.get(path, ()):
            for name in batch.schema.names:
                if name != _ROW_ID and len(batch) and (values := batch.column(name)[0].as_py()):
                    found[name] = values[0]
        return found

    def rows(self, path: str, components: Mapping[str, pa.DataType]) -> Iterator[Row]:
        """(tick, a list for each component) in the order of ticks."""
        table = self._sorted(path, components)
        for part in table.to_batches(max_chunksize=_SLICE):
            columns = [part.column(name).to_pylist() for name in components]
            yield from zip(part.column(_TICK).to_pylist(), zip(*columns, strict=True), strict=True)

    def points(self, path: str, component: str) -> Iterator[tuple[int, Floats]]:
        """(tick, (P, 3) points) in the order of ticks."""
        for part in self._sorted(path, {component: _POINT}).to_batches():
            lists = part.column(component)
            points = lists.values.values.to_numpy().reshape(-1, 3)
            ends = lists.offsets.to_numpy()
            for row, tick in enumerate(part.column(_TICK).to_numpy().tolist()):
                yield tick, points[ends[row] : ends[row + 1]]

    def _sorted(self, path: str, components: Mapping[str, pa.DataType]) -> pa.Table:
        schema = pa.schema(_KEYS | {name: pa.list_(kind) for name, kind in components.items()})
        table = pa.Table.from_batches(list(self._selected(path, schema)), schema)
        whole = pc.is_valid(table.column(_TICK))
        for name in components:
            whole = pc.and_(whole, pc.is_valid(table.column(name)))
        table = table.filter(whole)
        return table.sort_by([(_TICK, "ascending"), (_ROW_ID, "ascending")])

    def _selected(self, path: str, schema: pa.Schema) -> Iterator[pa.RecordBatch]:
        """The batches that have such columns, without rows that contradict themselves."""
        for batch in self._batches.get(path, ()):
            if not {*schema.names} <= {*batch.schema.names}:
                continue
            try:
                selected = batch.select(schema.names).cast(schema)
            except pa.ArrowException:
                self.damaged += 1
                continue
            if self._tick_s is not None:
                ticks, times_ns = (selected.column(name).cast(pa.int64()).to_numpy() for name in (_TICK, _TIME))
                in_time = np.abs(ticks * self._tick_s - times_ns * 1e-9) < self._tick_s / 2
                self.damaged += len(in_time) - int(np.count_nonzero(in_time))
                selected = selected.filter(pa.array(in_time))
            yield selected
