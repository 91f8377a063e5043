"""Replayed targets: where recorded animals or vehicles were, at any time, read from a CSV.

    tracks = read_tracks("baboons.csv.gz")
    tracks.names, tracks.duration_s, tracks.span_m, tracks.origin
    tracks.at(0, 12.3)  # (x, y, vx, vy), or None while the animal is absent

Two kinds of file, told apart by their header (other columns are ignored):
- `t,id,x,y`: seconds, any text, ENU meters about the mission's home; the time of an id never goes back.
- Movebank's export: `timestamp` (UTC), `location-long`, `location-lat`, `individual-local-identifier`; in any order.

GPS noise is kept: no smoothing, no speed limit, `visible` marks go unread. A jump in the file is a jump here.
"""

from __future__ import annotations

import gzip
import zlib
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain, pairwise
from math import hypot
from pathlib import Path
from statistics import median

from comms.frames import GeoPoint, enu_from_geo
from vehicle_sim.track_rows import Place, Rows, TracksError, parse_rows

__all__ = ["DEFAULT_MAX_GAP_S", "Tracks", "TracksError", "parse_tracks", "read_tracks"]

DEFAULT_MAX_GAP_S = 30.0

# Two fixes exactly max_gap_s apart must not be torn by the rounding of their times.
_CLOCK_GRAIN_S = 1e-6
# A home put at the origin is exactly what the autopilots hold: MAVLink carries 1e-7 degrees.
_ORIGIN_DECIMALS = 7
_GZIP_MAGIC = b"\x1f\x8b"


@dataclass(frozen=True, slots=True, kw_only=True)
class Tracks:
    """Recorded tracks on one clock, whose 0 is the first fix of all, and in one ENU plane.

    Attributes:
        names: the animals' ids, sorted as text; `index` in `at` is the place in this tuple.
        times_s, x_m, y_m: per animal, its fixes in order of time: seconds, meters east and north of `origin`.
        max_gap_s: an animal is absent between two fixes further apart than this.
        origin: the place the meters count from; None if the file is in meters and no home was given.
        left_out: ids without two fixes within `max_gap_s`: never present for any length of time.
        empty_positions: rows skipped for having no position.
        repeated_times: rows overruled by a later row of the same animal and time.
    """

    names: tuple[str, ...]
    times_s: tuple[tuple[float, ...], ...]
    x_m: tuple[tuple[float, ...], ...]
    y_m: tuple[tuple[float, ...], ...]
    max_gap_s: float
    origin: GeoPoint | None = None
    left_out: tuple[str, ...] = ()
    empty_positions: int = 0
    repeated_times: int = 0

    @property
    def duration_s(self) -> float:
        """Time of the last fix of all."""
        return max(times[-1] for times in self.times_s)

    @property
    def span_m(self) -> tuple[float, float, float, float]:
        """The box that holds every fix: its west, south, east and north edge. Walks all fixes: not for every tick."""
        xs, ys = tuple(chain(*self.x_m)), tuple(chain(*self.y_m))
        return min(xs), min(ys), max(xs), max(ys)

    @property
    def reach_m(self) -> float:
        """Distance of the furthest fix from the origin: the least radius of a round arena. Walks all fixes."""
        return max(map(hypot, chain(*self.x_m), chain(*self.y_m)))

    def at(self, index: int, t_s: float) -> tuple[float, float, float, float] | None:
        """East and north position (m) and velocity (m/s) on the straight line between two fixes; None while absent.

        Absent is an animal before its first fix, after its last, and between two further apart than `max_gap_s`.
        At a fix the position is the fix, and the velocity that of the stretch ahead; where there is none, that of the
        stretch behind; without either, zero.
        """
        times, xs, ys = self.times_s[index], self.x_m[index], self.y_m[index]
        i = bisect_right(times, t_s) - 1  # the last fix not after t_s
        if i < 0:
            return None
        start_s, x, y = times[i], xs[i], ys[i]
        longest_s = self.max_gap_s + _CLOCK_GRAIN_S
        if i + 1 < len(times):
            length_s = times[i + 1] - start_s
            if length_s <= longest_s:
                east, north, done = xs[i + 1] - x, ys[i + 1] - y, (t_s - start_s) / length_s
                return x + east * done, y + north * done, east / length_s, north / length_s
        if t_s > start_s:
            return None
        if i > 0:
            length_s = start_s - times[i - 1]
            if length_s <= longest_s:
                return x, y, (x - xs[i - 1]) / length_s, (y - ys[i - 1]) / length_s
        return x, y, 0.0, 0.0


def read_tracks(path: str | Path, *, home: GeoPoint | None = None, max_gap_s: float = DEFAULT_MAX_GAP_S) -> Tracks:
    """The tracks in a CSV file, plain or gzip (whatever its name), in meters about `home`.

    Without `home` a file in degrees is centered on the median of its fixes (altitude 0), and the mission can put its
    home there. A file in meters is about the home already.

    Raises:
        TracksError: no such file, not a CSV of tracks, bad rows (the first ten are listed), or nothing to replay.
    """
    return parse_tracks(_text_of(Path(path)), source=str(path), home=home, max_gap_s=max_gap_s)


def parse_tracks(
    text: str, *, source: str, home: GeoPoint | None = None, max_gap_s: float = DEFAULT_MAX_GAP_S
) -> Tracks:
    """`read_tracks` of a text; `source` names it in errors."""
    rows = parse_rows(text, source=source)
    longest = (max_gap_s + _CLOCK_GRAIN_S) * rows.layout.ticks_per_s
    times = {name: sorted(rows.fixes[name]) for name in sorted(rows.fixes)}
    names = tuple(name for name, own in times.items() if any(b - a <= longest for a, b in pairwise(own)))
    if not names:
        found = f"{len(times)} ids with {sum(map(len, times.values()))} fixes, none to replay"
        raise TracksError(source, [f"{found}; allowed: at least one id with two fixes at most {max_gap_s:g} s apart"])
    start = min(times[name][0] for name in names)
    if rows.layout.geographic and home is None:
        home = _center(chain.from_iterable(rows.fixes[name].values() for name in names))
    places = [_enu_places(rows, home, name, times[name]) for name in names]
    return Tracks(
        names=names,
        times_s=tuple(tuple((ticks - start) / rows.layout.ticks_per_s for ticks in times[name]) for name in names),
        x_m=tuple(tuple(x for x, _ in own) for own in places),
        y_m=tuple(tuple(y for _, y in own) for own in places),
        max_gap_s=max_gap_s,
        origin=home,
        left_out=tuple(name for name in times if name not in names),
        empty_positions=rows.empty_positions,
        repeated_times=rows.repeated_times,
    )


def _text_of(path: Path) -> str:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise TracksError(str(path), [f"{error.strerror}; allowed: a CSV file, plain or gzip"]) from error
    if data.startswith(_GZIP_MAGIC):
        try:
            data = gzip.decompress(data)
        except (gzip.BadGzipFile, EOFError, zlib.error) as error:
            raise TracksError(str(path), ["broken or cut gzip; allowed: a whole gzip file"]) from error
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        found = f"byte 0x{error.object[error.start]:02x}"
        raise TracksError(str(path), [f"line {line}: {found}; allowed: text in UTF-8"]) from error


def _center(places: Iterable[Place]) -> GeoPoint:
    """The median of places in degrees: unlike the middle of their box it ignores a few wild fixes."""
    longitudes, latitudes = zip(*places, strict=True)
    east = median(_unwrapped(longitude, about=longitudes[0]) for longitude in longitudes)
    return GeoPoint(
        latitude_deg=round(median(latitudes), _ORIGIN_DECIMALS),
        longitude_deg=round(_unwrapped(east, about=0.0), _ORIGIN_DECIMALS),
        altitude_m=0.0,
    )


def _enu_places(rows: Rows, home: GeoPoint | None, name: str, times: Iterable[float]) -> list[Place]:
    fixes = rows.fixes[name]
    if not rows.layout.geographic or home is None:
        return [fixes[ticks] for ticks in times]
    return [_enu(home, *fixes[ticks]) for ticks in times]


def _enu(home: GeoPoint, longitude_deg: float, latitude_deg: float) -> Place:
    near = _unwrapped(longitude_deg, about=home.longitude_deg)
    east, north, _ = enu_from_geo(home, GeoPoint(latitude_deg, near, home.altitude_m))
    return east, north


def _unwrapped(longitude_deg: float, *, about: float) -> float:
    """The same meridian within half a turn of `about`, so that tracks may cross the date line."""
    if longitude_deg - about > 180.0:
        return longitude_deg - 360.0
    if longitude_deg - about < -180.0:
        return longitude_deg + 360.0
    return longitude_deg
