"""The parameters of an ArduCopter that act here, in its own units. A value travels as a float cast from its C type."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite
from typing import NamedTuple

from vehicle_sim.flight import FlightLimits

INT8, INT16, INT32, REAL32 = 2, 4, 6, 9  # MAV_PARAM_TYPE
_RANGES = {INT8: (-128, 127), INT16: (-32768, 32767), INT32: (-(2**31), 2**31 - 128), REAL32: (-3.4e38, 3.4e38)}


class Row(NamedTuple):
    """One parameter. A read-only one answers with what it is."""

    name: str
    type: int
    default: float
    read_only: bool = False


TABLE: tuple[Row, ...] = (
    Row("ANGLE_MAX", INT16, 3000),  # centidegrees
    Row("BATT_CAPACITY", INT32, 3300, read_only=True),  # mAh: the battery is what it is
    Row("DISARM_DELAY", INT8, 10),  # s; 0 never
    Row("FS_GCS_ENABLE", INT8, 0),
    Row("FS_GCS_TIMEOUT", REAL32, 5),  # s
    Row("GUID_TIMEOUT", REAL32, 3),  # s
    Row("LAND_ALT_LOW", INT16, 1000),  # cm
    Row("LAND_SPEED", INT16, 50),  # cm/s
    Row("LAND_SPEED_HIGH", INT16, 0),  # cm/s; 0: WPNAV_SPEED_DN
    Row("RTL_ALT", INT32, 1500),  # cm above home
    Row("RTL_ALT_FINAL", INT16, 0),  # cm above home to stay at; 0: land
    Row("RTL_LOIT_TIME", INT32, 5000),  # ms above home before the descent
    Row("RTL_SPEED", INT16, 0),  # cm/s; 0: WPNAV_SPEED
    Row("SYSID_MYGCS", INT16, 255),
    Row("SYSID_THISMAV", INT16, 1, read_only=True),
    Row("WPNAV_ACCEL", REAL32, 250),  # cm/s2
    Row("WPNAV_SPEED", REAL32, 1000),  # cm/s
    Row("WPNAV_SPEED_DN", REAL32, 150),  # cm/s
    Row("WPNAV_SPEED_UP", REAL32, 250),  # cm/s
)
LIMIT_NAMES = frozenset({"ANGLE_MAX", "WPNAV_ACCEL", "WPNAV_SPEED", "WPNAV_SPEED_DN", "WPNAV_SPEED_UP"})
INDEX: dict[str, int] = {row.name: index for index, row in enumerate(TABLE)}


class Parameters:
    """One vehicle's parameters: `parameters["RTL_ALT"]` is the stored value."""

    def __init__(self, *, system_id: int, limits: FlightLimits, capacity_mah: float) -> None:
        self._values = {row.name: float(row.default) for row in TABLE}
        self._values |= {
            "SYSID_THISMAV": float(system_id),
            "BATT_CAPACITY": float(round(capacity_mah)),
            "ANGLE_MAX": float(round(100.0 * limits.tilt_deg)),
            "WPNAV_SPEED": 100.0 * limits.speed_m_s,
            "WPNAV_SPEED_UP": 100.0 * limits.climb_m_s,
            "WPNAV_SPEED_DN": 100.0 * limits.descent_m_s,
            "WPNAV_ACCEL": 100.0 * limits.acceleration_m_s2,
        }

    def __getitem__(self, name: str) -> float:
        return self._values[name]

    def store(self, name: str, value: float) -> bool:
        """Store `value` as its C type takes it (truncated, clamped). False if it was not: not finite or read-only."""
        row = TABLE[INDEX[name]]
        if row.read_only or not isfinite(value):
            return False
        lowest, highest = _RANGES[row.type]
        clamped = max(lowest, min(highest, value))
        self._values[name] = float(clamped if row.type == REAL32 else round(clamped))
        return True

    def limits(self, limits: FlightLimits) -> FlightLimits:
        """`limits` with what the parameters say; a value no vehicle can have is brought to the nearest it can."""
        return replace(
            limits,
            speed_m_s=_within(self["WPNAV_SPEED"] / 100.0, 0.1, 100.0),
            climb_m_s=_within(self["WPNAV_SPEED_UP"] / 100.0, 0.1, 100.0),
            descent_m_s=_within(self["WPNAV_SPEED_DN"] / 100.0, 0.1, 100.0),
            acceleration_m_s2=_within(self["WPNAV_ACCEL"] / 100.0, 0.5, 100.0),
            tilt_deg=_within(self["ANGLE_MAX"] / 100.0, 10.0, 80.0),
        )


def _within(value: float, lowest: float, highest: float) -> float:
    return max(lowest, min(highest, value))
