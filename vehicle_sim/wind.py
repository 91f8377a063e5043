"""Wind over one vehicle: a steady part for the whole mission and gusts of its own.

Gusts are drawn once a second from `comms.chance` and joined by straight lines, so that the air at a time is a pure
function of (seed, vehicle, time) whatever the tick length.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, floor, isfinite, radians, sin

from comms.chance import GUST, draw

GUST_PERIOD_S = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Wind:
    """The wind of a mission.

    Attributes:
        speed_m_s: steady speed. from_deg: where it comes from, clockwise from north (as weather reports say it).
        gust_m_s: the largest gust, on each horizontal axis.
    """

    speed_m_s: float = 0.0
    from_deg: float = 0.0
    gust_m_s: float = 0.0

    def __post_init__(self) -> None:
        for name in ("speed_m_s", "gust_m_s"):
            if not 0.0 <= getattr(self, name) < 100.0:
                raise ValueError(f"wind.{name} is 0 to 100 m/s, not {getattr(self, name)}")
        if not isfinite(self.from_deg):
            raise ValueError(f"wind.from_deg is an angle in degrees, not {self.from_deg}")


class LocalWind:
    """The air at one vehicle's place."""

    def __init__(self, wind: Wind, *, seed: int, who: int) -> None:
        self._seed = seed
        self._who = who
        self.change(wind)

    def change(self, wind: Wind) -> None:
        """Another wind from now on."""
        toward = radians(wind.from_deg)
        self.steady_ne_m_s = (-wind.speed_m_s * cos(toward), -wind.speed_m_s * sin(toward))
        self._gust_m_s = wind.gust_m_s
        self._knot = -1
        self._ends = ((0.0, 0.0), (0.0, 0.0))

    def at(self, time_s: float) -> tuple[float, float]:
        """The air's velocity, north and east, m/s."""
        north, east = self.steady_ne_m_s
        if self._gust_m_s == 0.0:
            return north, east
        knot = floor(time_s / GUST_PERIOD_S)
        if knot != self._knot:
            self._knot = knot
            self._ends = (self._gust(knot), self._gust(knot + 1))
        share = time_s / GUST_PERIOD_S - knot
        (n0, e0), (n1, e1) = self._ends
        return north + n0 + share * (n1 - n0), east + e0 + share * (e1 - e0)

    def _gust(self, knot: int) -> tuple[float, float]:
        north = draw(self._seed, knot, 2 * self._who, GUST)
        east = draw(self._seed, knot, 2 * self._who + 1, GUST)
        return (2.0 * north - 1.0) * self._gust_m_s, (2.0 * east - 1.0) * self._gust_m_s
