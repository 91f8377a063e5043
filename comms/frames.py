"""Coordinate frames: the mission's local east-north-up plane, MAVLink's north-east-down, and the globe.

The mission has ONE local frame, ENU in meters, whose origin is the mission's home. Every autopilot has its own NED
frame at its own boot place; `enu_from_geo` brings its origin into the mission's frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians

Vec3 = tuple[float, float, float]

# WGS84 mean of the meridional and prime-vertical radii is not needed: the tangent plane below is the one ArduPilot
# uses (LATLON_TO_M), so that our meters agree with the autopilot's.
METRES_PER_DEGREE = 111319.49079327357


@dataclass(frozen=True, slots=True)
class GeoPoint:
    """A place on the globe: WGS84 degrees and meters above mean sea level."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float


def geo_from_enu(origin: GeoPoint, enu_m: Vec3) -> GeoPoint:
    """The place `enu_m` meters east, north and up of `origin` (tangent plane; good to millimeters within 10 km)."""
    east, north, up = enu_m
    return GeoPoint(
        latitude_deg=origin.latitude_deg + north / METRES_PER_DEGREE,
        longitude_deg=origin.longitude_deg + east / (METRES_PER_DEGREE * cos(radians(origin.latitude_deg))),
        altitude_m=origin.altitude_m + up,
    )


def enu_from_geo(origin: GeoPoint, place: GeoPoint) -> Vec3:
    """Meters east, north and up of `origin`: the inverse of `geo_from_enu`."""
    return (
        (place.longitude_deg - origin.longitude_deg) * METRES_PER_DEGREE * cos(radians(origin.latitude_deg)),
        (place.latitude_deg - origin.latitude_deg) * METRES_PER_DEGREE,
        place.altitude_m - origin.altitude_m,
    )


def swap_enu_ned(vector: Vec3) -> Vec3:
    """ENU to NED or NED to ENU: the same swap both ways."""
    x, y, z = vector
    return (y, x, -z)
