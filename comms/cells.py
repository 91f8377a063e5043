"""Points of a plane in square cells: who is near a place is found without a look at all others.

    cells = Cells([(0.0, 0.0), (3.0, 0.0), None, (90.0, 0.0)], range_m=5.0)
    cells.near(1.0, 0.0)  # [0, 1]

With a thousand agents the pairs are a million, and those within range a few thousand.
"""

from __future__ import annotations

from collections.abc import Sequence

_Cell = tuple[float, float]
_AROUND = tuple((column, row) for column in (-1.0, 0.0, 1.0) for row in (-1.0, 0.0, 1.0))
# Cells are wider than the range by this share, so that a pair at the very range is never two cells apart for rounding.
_MARGIN = 1e-9


class Cells:
    """Where these points are; None is nowhere, and so is what is not finite.

    Args:
        range_m: whatever lies so near to a place must be found there.
    """

    def __init__(self, points: Sequence[tuple[float, float] | None], *, range_m: float) -> None:
        self._side_m = range_m * (1.0 + _MARGIN)
        self._members: dict[_Cell, list[int]] = {}
        for index, point in enumerate(points):
            if point is not None:
                self._members.setdefault(self._cell(*point), []).append(index)
        self._around: dict[_Cell, list[int]] = {}  # found before

    def near(self, x_m: float, y_m: float) -> list[int]:
        """The numbers of all points within range of a place, and of some beyond it, in order."""
        cell = self._cell(x_m, y_m)
        found = self._around.get(cell)
        if found is None:
            found = self._around[cell] = self._gathered(*cell)
        return found

    def _cell(self, x_m: float, y_m: float) -> _Cell:
        return x_m // self._side_m, y_m // self._side_m

    def _gathered(self, column: float, row: float) -> list[int]:
        members = self._members
        return sorted(index for c, r in _AROUND for index in members.get((column + c, row + r), ()))
