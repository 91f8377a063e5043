"""Rally points: places to return to instead of home, if one is nearer."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from comms.frames import Vec3


def refuge_ned_m(
    home_ned_m: Vec3,
    rallies_ned_m: Iterable[Vec3],
    *,
    distance_m: Callable[[Vec3], float],
    furthest_m: float,
    home_counts: bool,
) -> Vec3:
    """The nearest rally point within `furthest_m` (0: any); home if there is none, or if it is nearer and counts."""
    near = [place for place in rallies_ned_m if furthest_m <= 0.0 or distance_m(place) <= furthest_m]
    if not near:
        return home_ned_m
    return min([home_ned_m, *near] if home_counts else near, key=distance_m)
