"""Where an item of a plan is, in the vehicle's own frame."""

from __future__ import annotations

from comms.frames import GeoPoint, Vec3, enu_from_geo, swap_enu_ned
from vehicle_sim.autopilot.plans.item import Item

ABOVE_SEA_FRAMES = frozenset({0, 5})


def ned_from_item(item: Item, *, origin: GeoPoint, home_ned_m: Vec3, otherwise_ned_m: Vec3) -> Vec3:
    """North, east, down meters of `origin`. No place (0, 0), no height (0): those of `otherwise_ned_m`."""
    north_m, east_m, down_m = otherwise_ned_m
    if item.x or item.y:
        place = GeoPoint(item.latitude_deg, item.longitude_deg, origin.altitude_m)
        north_m, east_m, _ = swap_enu_ned(enu_from_geo(origin, place))
    if item.z:
        down_m = origin.altitude_m - item.z if item.frame in ABOVE_SEA_FRAMES else home_ned_m[2] - item.z
    return north_m, east_m, down_m
