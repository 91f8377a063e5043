"""One item of a plan, and its two forms on the wire: MISSION_ITEM (floats) and MISSION_ITEM_INT (degrees times 1e7)."""

from __future__ import annotations

from math import isfinite
from typing import Any, NamedTuple

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint

DEGREES_E7 = 1e-7
NOWHERE_E7 = 2_147_483_647  # what no latitude or longitude is


class Item(NamedTuple):
    """A row of a plan. x and y are degrees times 1e7 where the command has a place; z is meters in `frame`."""

    command: int
    frame: int = 0
    param1: float = 0.0
    param2: float = 0.0
    param3: float = 0.0
    param4: float = 0.0
    x: int = 0
    y: int = 0
    z: float = 0.0

    @property
    def params(self) -> tuple[float, float, float, float]:
        return self.param1, self.param2, self.param3, self.param4

    @property
    def latitude_deg(self) -> float:
        return self.x * DEGREES_E7

    @property
    def longitude_deg(self) -> float:
        return self.y * DEGREES_E7


def received(message: Any) -> Item:
    """What a MISSION_ITEM or MISSION_ITEM_INT says; a float place that is none becomes NOWHERE_E7."""
    x, y = message.x, message.y
    if message.get_msgId() == dialect.MAVLINK_MSG_ID_MISSION_ITEM:
        x, y = _e7(x), _e7(y)
    return Item(
        message.command, message.frame, message.param1, message.param2, message.param3, message.param4, x, y, message.z
    )


def as_int(item: Item, *, to: tuple[int, int], seq: int, current: bool, kind: int) -> Any:
    return dialect.MAVLink_mission_item_int_message(
        *to, seq, item.frame, item.command, int(current), 1, *item.params, item.x, item.y, item.z, kind
    )


def as_float(item: Item, *, to: tuple[int, int], seq: int, current: bool, kind: int) -> Any:
    return dialect.MAVLink_mission_item_message(
        *to, seq, item.frame, item.command, int(current), 1, *item.params, item.latitude_deg, item.longitude_deg,
        item.z, kind,
    )  # fmt: skip


def home_item(home: GeoPoint) -> Item:
    """Item 0 of every mission: home, above sea level."""
    return Item(dialect.MAV_CMD_NAV_WAYPOINT, 0, x=_e7(home.latitude_deg), y=_e7(home.longitude_deg), z=home.altitude_m)


def _e7(degrees: float) -> int:
    return round(degrees / DEGREES_E7) if isfinite(degrees) and abs(degrees) <= 180.0 else NOWHERE_E7
