"""The mission in plain values, for whoever counts: `playback` rebuilds every observation from these rows.

What is drawn is drawn for the eye, and seldom; the ledger has what metrics are counted from, at the very tick.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields
from operator import attrgetter
from typing import Any

import pyarrow as pa
import rerun as rr

from missions.observation import Observation, Totals
from missions.recording.block import Block
from missions.recording.columns import Rows
from missions.recording.scene import Scene

PHASE, DUTIES, TAGS, CALLS, TARGETS, TOTALS = (
    f"/ledger/{name}" for name in ("phase", "duties", "tags", "calls", "targets", "totals")
)
TOTAL_NAMES = tuple(field.name for field in fields(Totals))
NOBODY = -1
_all_totals = attrgetter(*TOTAL_NAMES)

Values = tuple[Any, ...]
_WHOLE, _REAL, _TEXT = pa.int64(), pa.float64(), pa.string()


class Ledger:
    """Phase, duties, tags, calls, and which targets are there and seen: when they change.

    Totals at every tick, whether somebody sends or not: they are what says that there was a tick.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._last: dict[str, Values] = {}

    def tell_anew(self) -> None:
        """Tell next what holds, whether it is new or not."""
        self._last.clear()

    def rows(self, block: Block) -> Iterator[Rows]:
        """The changes."""
        yield self._table(PHASE, block, _phase, {"phase": _TEXT, "mission_began_at": _WHOLE})
        yield self._table(DUTIES, block, _duties, {"helping": _WHOLE, "flight_mode": _TEXT})
        yield self._table(TAGS, block, _tags, {"agent": _WHOLE, "target": _WHOLE})
        yield self._table(
            CALLS, block, _calls, {"agent": _WHOLE, "target": _WHOLE, "urgent": _WHOLE, "loss_in_s": _REAL}, keys=3
        )
        yield self._table(TARGETS, block, _targets, {"present": _WHOLE, "seen": _WHOLE})
        yield _rows(TOTALS, block, [_totals(seen) for seen in block.observations], {"total": _WHOLE})

    def _table(
        self,
        path: str,
        block: Block,
        entries_of: Callable[[Observation], Sequence[Values]],
        types: dict[str, pa.DataType],
        *,
        keys: int | None = None,
    ) -> Rows:
        """A row for each tick at which an entry changed in its first `keys` values (default: all)."""
        changed, rows = [], []
        for seen in block.observations:
            entries = entries_of(seen)
            key = tuple(entry[:keys] for entry in entries)
            if self._last.get(path) != key:
                self._last[path] = key
                changed.append(seen)
                rows.append(entries)
        return _rows(path, Block(self._scene, changed), rows, types)


def _rows(path: str, block: Block, rows: Sequence[Sequence[Values]], types: dict[str, pa.DataType]) -> Rows:
    """A row of entries for each tick of `block`; a column a value."""
    arrays = {
        name: pa.array([entry[place] for row in rows for entry in row], kind)
        for place, (name, kind) in enumerate(types.items())
    }
    columns = rr.AnyValues.columns(drop_untyped_nones=False, **arrays)
    return Rows(path, block, columns.partition([len(row) for row in rows]))


def _phase(seen: Observation) -> Sequence[Values]:
    return ((seen.phase.value, NOBODY if seen.mission_tick is None else seen.tick - seen.mission_tick),)


def _duties(seen: Observation) -> Sequence[Values]:
    return tuple((NOBODY if status.helping is None else status.helping, status.flight_mode) for status in seen.statuses)


def _tags(seen: Observation) -> Sequence[Values]:
    return tuple((status.uid, target) for status in seen.statuses for target in status.tags)


def _calls(seen: Observation) -> Sequence[Values]:
    return tuple(
        (status.uid, call.target, int(call.urgent), call.loss_in_s) for status in seen.statuses for call in status.calls
    )


def _totals(seen: Observation) -> Sequence[Values]:
    return tuple([(total,) for total in _all_totals(seen.totals)])


def _targets(seen: Observation) -> Sequence[Values]:
    return tuple((int(target.present), int(target.seen)) for target in seen.targets)
