"""The linear bottleneck assignment: as many pairs as can be, and of these the one whose worst pair costs least.

Rows are matched to columns by augmenting paths; the worst cost is lowered until fewer pairs could be had.
"""

from __future__ import annotations

from math import inf

from missions.study.compiled.rules import inlined
from missions.study.compiled.state import Array
from swarm_agent.bcmommt.belief import FAR, NOBODY


@inlined
def match_bottleneck(cost: Array, column_of: Array, row_of: Array, came_from: Array, queue: Array) -> None:
    """Fill column_of (m) and row_of (n) from cost (m, n); NOBODY where there is no partner.

    Args:
        cost: FAR or more where two cannot be partners. came_from (n), queue (m): scratch.
    """
    limit = FAR
    most = _match(cost, limit, column_of, row_of, came_from, queue)
    lower = _worst(cost, column_of)
    while most > 0:
        if _match(cost, lower, column_of, row_of, came_from, queue) < most:
            _match(cost, limit, column_of, row_of, came_from, queue)
            return
        limit, lower = lower, _worst(cost, column_of)


@inlined
def _match(cost: Array, limit: float, column_of: Array, row_of: Array, came_from: Array, queue: Array) -> int:
    """A matching of most pairs among those that cost less than `limit`. Returns how many."""
    m, n = cost.shape
    for row in range(m):
        column_of[row] = NOBODY
    for column in range(n):
        row_of[column] = NOBODY
    pairs = 0
    for row in range(m):
        end = _search(cost, limit, row, column_of, row_of, came_from, queue)
        while end != NOBODY:  # along the path back to `row` everybody takes the next column
            partner = came_from[end]
            row_of[end] = partner
            column_of[partner], end = end, column_of[partner]
        pairs += column_of[row] != NOBODY
    return pairs


@inlined
def _search(
    cost: Array, limit: float, start: int, column_of: Array, row_of: Array, came_from: Array, queue: Array
) -> int:
    """The free column at the end of a shortest augmenting path from row `start`, as `came_from` tells; or NOBODY."""
    n = len(came_from)
    for column in range(n):
        came_from[column] = NOBODY
    head, tail = 0, 1
    queue[0] = start
    while head < tail:
        row = queue[head]
        head += 1
        for column in range(n):
            if cost[row, column] < limit and came_from[column] == NOBODY:
                came_from[column] = row
                if row_of[column] == NOBODY:
                    return column
                queue[tail] = row_of[column]
                tail += 1
    return NOBODY


@inlined
def _worst(cost: Array, column_of: Array) -> float:
    """The highest cost of a matched pair."""
    worst = -inf
    for row in range(len(column_of)):
        if column_of[row] != NOBODY:
            worst = max(worst, cost[row, column_of[row]])
    return worst
