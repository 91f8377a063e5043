"""The way back that SMART_RTL flies: places left behind since arming, without loops and without needless corners."""

from __future__ import annotations

from math import dist, sqrt

from comms.frames import Vec3

CORNER_SHARE = 0.5  # of SRTL_ACCURACY: how far a place may lie beside the simplified way
LOOP_SHARE = 0.99  # of SRTL_ACCURACY: how near the way must come to itself to be a loop
MOST = 500  # places, whatever SRTL_POINTS says: cleaning a trail takes the square of its length


class Breadcrumbs:
    """One flight's trail, north-east-down meters, from home on. A full one is cleaned, then given up.

    Attributes:
        active: a trail has begun and was not given up.
    """

    def __init__(self) -> None:
        self._trail: list[Vec3] = []
        self.active = False

    def begin(self, home_ned_m: Vec3) -> None:
        self._trail = [home_ned_m]
        self.active = True

    def forget(self) -> None:
        self._trail.clear()
        self.active = False

    def drop(self, place_ned_m: Vec3, *, apart_m: float, most: int) -> bool:
        """Leave `place_ned_m` behind if it is `apart_m` from the last. False: no room, the trail is given up."""
        if not self.active or _squared(place_ned_m, self._trail[-1]) < apart_m * apart_m:
            return True
        most = min(most, MOST)
        if len(self._trail) >= most:
            self._trail = cleaned(self._trail, accuracy_m=apart_m)
        if len(self._trail) >= most:
            self._trail.clear()
            self.active = False
            return False
        self._trail.append(place_ned_m)
        return True

    def clean(self, *, accuracy_m: float) -> None:
        """Shorten the trail before it is flown back."""
        self._trail = cleaned(self._trail, accuracy_m=accuracy_m)

    def pick_up(self) -> Vec3 | None:
        """The last place, taken off the trail; None when nothing is left but home, which stays."""
        return self._trail.pop() if len(self._trail) > 1 else None

    @property
    def home_ned_m(self) -> Vec3:
        return self._trail[0]

    def put_back(self, place_ned_m: Vec3) -> None:
        """A place that was picked up and not reached."""
        self._trail.append(place_ned_m)


def cleaned(trail: list[Vec3], *, accuracy_m: float) -> list[Vec3]:
    """The trail with its loops cut out, then without the places that lie on the way between others."""
    accuracy_m = max(0.0, accuracy_m)  # a parameter can be anything
    return simplified(pruned(trail, near_m=LOOP_SHARE * accuracy_m), beside_m=CORNER_SHARE * accuracy_m)


def pruned(trail: list[Vec3], *, near_m: float) -> list[Vec3]:
    """From each place straight on from the last later one that lies within `near_m` of it."""
    kept: list[Vec3] = []
    index, near_m2 = 0, near_m * near_m
    while index < len(trail):
        place = trail[index]
        kept.append(place)
        again = (later for later in range(len(trail) - 1, index, -1) if _squared(trail[later], place) <= near_m2)
        index = max(index + 1, next(again, index) + 1)
    return kept


def simplified(trail: list[Vec3], *, beside_m: float) -> list[Vec3]:
    """Ramer-Douglas-Peucker: no place of `trail` lies further than `beside_m` from the result."""
    if len(trail) < 3:
        return list(trail)
    keep = {0, len(trail) - 1}
    spans = [(0, len(trail) - 1)]
    while spans:
        first, last = spans.pop()
        worst_m, worst = 0.0, first
        for index in range(first + 1, last):
            off_m = _off_line_m(trail[index], trail[first], trail[last])
            if off_m > worst_m:
                worst_m, worst = off_m, index
        if worst_m > beside_m:
            keep.add(worst)
            spans += [(first, worst), (worst, last)]
    return [trail[index] for index in sorted(keep)]


def _off_line_m(place: Vec3, start: Vec3, end: Vec3) -> float:
    """Distance of `place` from the straight piece between two others."""
    length_m2 = _squared(start, end)
    if length_m2 == 0.0:
        return sqrt(_squared(place, start))
    along = sum((p - s) * (e - s) for p, s, e in zip(place, start, end, strict=True)) / length_m2
    share = max(0.0, min(1.0, along))
    return dist(place, [s + share * (e - s) for s, e in zip(start, end, strict=True)])


def _squared(a: Vec3, b: Vec3) -> float:
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2
