"""What several reports need: boot time, places and headings, and clamping to wire types."""

from __future__ import annotations

from math import pi

from comms.frames import GeoPoint, Vec3, geo_from_enu
from vehicle_sim.autopilot.core import Autopilot

# HEARTBEAT.base_mode (MAV_MODE_FLAG).
CUSTOM_MODE, AUTO_ENABLED, GUIDED_ENABLED, STABILIZED, MANUAL_INPUT, SAFETY_ARMED = 1, 4, 8, 16, 64, 128


def boot_ms(pilot: Autopilot) -> int:
    """Milliseconds since power-on; wraps after 49 days, as the wire type does."""
    return round((pilot.now_s - pilot.started_at_s) * 1000.0) & 0xFFFFFFFF


def place(pilot: Autopilot) -> GeoPoint:
    """Where it believes it is."""
    belief = pilot.estimate
    return place_of(pilot, (belief.north_m, belief.east_m, belief.down_m))


def place_of(pilot: Autopilot, ned_m: Vec3) -> GeoPoint:
    north, east, down = ned_m
    return geo_from_enu(pilot.origin, (east, north, -down))


def heading_deg(pilot: Autopilot) -> float:
    """Where it believes its nose points, 0 to 360 clockwise from north."""
    return (pilot.estimate.yaw_rad % (2.0 * pi)) * 180.0 / pi


def throttle(pilot: Autopilot) -> float:
    """Share of full throttle: 34 % hovering, as recorded."""
    return min(1.0, 0.34 * pilot.charge.current_a / pilot.charge.battery.hover_current_a)


def remaining_percent(pilot: Autopilot, capacity_mah: float) -> int:
    """What the autopilot believes to be left of a battery of `capacity_mah`, less what was drawn."""
    if capacity_mah <= 0.0:
        return 0
    return round(100.0 * max(0.0, 1.0 - pilot.charge.consumed_mah / capacity_mah))


def wire_place(where: GeoPoint) -> tuple[int, int, int]:
    return i32(where.latitude_deg * 1e7), i32(where.longitude_deg * 1e7), i32(where.altitude_m * 1000.0)


def i16(value: float) -> int:
    return max(-32768, min(32767, round(value)))


def u16(value: float) -> int:
    return max(0, min(65535, round(value)))


def i32(value: float) -> int:
    return max(-(2**31), min(2**31 - 1, round(value)))
