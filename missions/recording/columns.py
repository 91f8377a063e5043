"""From arrays to rerun columns: rows of unequal length, line strips without a Python loop, small color sums."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt
import pyarrow as pa
import rerun as rr
from rerun import ComponentColumn

from comms.status import Activity
from missions.recording.block import Block, Colors, Floats, Ints, Mask


@dataclass(frozen=True, slots=True)
class Rows:
    """Columns of one entity, one row for each tick of `block`."""

    path: str
    block: Block
    columns: Iterable[ComponentColumn]


class Layer(Protocol):
    """One kind of thing to draw: turns blocks, in order of time, into rows."""

    def rows(self, block: Block) -> Iterable[Rows]: ...


@runtime_checkable
class TellsChanges(Protocol):
    """A layer that records what changes: in a new file it tells all of it anew."""

    def tell_anew(self) -> None: ...


def pieces(lines: npt.ArrayLike, colors: Colors | None, counts: Ints) -> rr.ComponentColumnList:
    """Lines (..., P, 3) of P points each as columns of LineStrips3D; `counts` says how many belong to each row."""
    points = np.asarray(lines, dtype=np.float32)
    each = points.shape[-2]
    return strips(points.reshape(-1, 3), np.full(points[..., 0].size // each, each), colors, counts)


def strips(points: Floats, lengths: Ints, colors: Colors | None, counts: Ints) -> rr.ComponentColumnList:
    """Lines of `lengths` points each, one after the other in `points` (P, 3), as columns of LineStrips3D."""
    offsets = pa.array(np.concatenate(([0], np.cumsum(lengths))).astype(np.int32))
    arrow_type = rr.components.LineStrip3DBatch._ARROW_DATATYPE
    vectors = rr.encodings.Vec3DBatch(points).as_arrow_array()
    columns: rr.ComponentColumnList = rr.LineStrips3D.columns(
        strips=pa.ListArray.from_arrays(offsets, vectors, type=arrow_type), colors=colors
    )
    return columns.partition(counts)


def rings(centers: Floats, radii_m: Floats | float, colors: Colors, counts: Ints) -> rr.ComponentColumnList:
    """Flat rings (R, 3) as columns of Cylinders3D, one radius for all or one each.

    The radius is repeated for each ring: were it static, a row without centers would still show one, at the origin.
    """
    radii = np.full(len(centers), radii_m, dtype=np.float32)
    return rr.Cylinders3D.columns(centers=centers, radii=radii, colors=colors).partition(counts)


def faded(colors: Colors, alpha: int) -> Colors:
    """`colors` with another opacity, 0 to 255."""
    return (colors & np.uint32(0xFFFFFF00)) | np.uint32(alpha)


def ramp(start: int, end: int, count: int) -> Colors:
    """`count` colors from `start` to `end`, channel by channel."""
    shifts = np.array((24, 16, 8, 0), dtype=np.uint32)
    first, last = (start >> shifts) & 0xFF, (end >> shifts) & 0xFF
    channels = np.round(np.linspace(first, last, count)).astype(np.uint32)
    colors: Colors = np.bitwise_or.reduce(channels << shifts, axis=1)
    return colors


def doing(block: Block, wanted: Callable[[Activity], bool]) -> Mask:
    """(K, N): which agents do something wanted."""
    rows = [[wanted(activity) for activity in row] for row in block.activities]
    return np.array(rows, dtype=np.bool_).reshape(len(block), block.scene.n_agents)


def on_ground(points: Floats) -> Floats:
    """(..., 2) places as (..., 3) points at height zero."""
    return np.concatenate((points, np.zeros_like(points[..., :1])), axis=-1)
