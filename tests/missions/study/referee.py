"""Definitions 2 to 7 from ground truth, by brute force: what B-CMOMMT's agents should agree on, were they all-knowing.

Ticks T, agents m, targets n. A graph E(t) is its weights (T, m, n): the distance in meters along an edge, infinite
where there is none. A tagging Phi is flags (T, m, n).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]


def environment(agents: Floats, targets: Floats, *, sensing_range_m: float) -> Floats:
    """Definition 2: an edge for every target within an agent's sensor. agents (T, m, 2), targets (T, n, 2)."""
    apart = targets[:, None, :, :] - agents[:, :, None, :]
    squared = (apart**2).sum(axis=-1)
    weights: Floats = np.where(squared <= sensing_range_m**2, np.sqrt(squared), np.inf)
    return weights


def tagging(weights: Floats) -> Flags:
    """Definitions 3 and 4: Phi holds the edges shorter than every other edge of the same target."""
    tags = np.isfinite(weights)
    for i in range(weights.shape[1]):
        for other in range(weights.shape[1]):
            if other != i:  # no edge is infinitely long: it never beats one
                tags[:, i] &= weights[:, i] < weights[:, other]
    return tags


def distance_vector(weights: Floats, tags: Flags) -> Floats:
    """Definition 5: how far each target is from whoever tags it, 0 if nobody does: (T, n). Columns sum to 1 at most."""
    distances: Floats = np.where(tags, weights, 0.0).sum(axis=1)
    return distances


def time_of_loss(weights: Floats, tags: Flags, *, tick_s: float) -> Floats:
    """Definition 6 with hindsight: seconds until the tagged target leaves the agent's sensor: (T, m, n).

    Infinite where the agent does not tag the target, or does not lose sight of it before the trace ends.
    """
    remaining = np.full(weights.shape, np.inf)
    for tick in range(len(weights) - 2, -1, -1):
        remaining[tick] = np.where(np.isfinite(weights[tick + 1]), remaining[tick + 1], 0.0) + tick_s
    return np.where(tags, remaining, np.inf)


def events(tags: Flags) -> Floats:
    """Definition 7, delta being a tick: target losses, discoveries and tag switches in each tick: (T, 3).

    Nothing is tagged before the first tick. Where two agents tag one target, the definition would see a switch between
    them in every tick: here whoever is switched from tags no longer.
    """
    before = np.concatenate([np.zeros_like(tags[:1]), tags[:-1]])
    had, has = before.any(axis=1), tags.any(axis=1)
    switched = np.zeros_like(had)
    for k in range(tags.shape[1]):
        for other in range(tags.shape[1]):
            if other != k:
                switched |= before[:, k] & tags[:, other] & ~tags[:, k]
    counts: Floats = np.stack([had & ~has, has & ~had, switched], axis=-1).sum(axis=1)
    return counts


def longest(flags: Flags) -> int:
    """The longest run of set flags along the first axis of (T, n), in ticks, over all columns."""
    running = np.zeros(flags.shape[1], np.int64)
    most = 0
    for row in flags:
        running = np.where(row, running + 1, 0)
        most = max(most, int(running.max()))
    return most
