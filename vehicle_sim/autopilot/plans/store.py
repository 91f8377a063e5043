"""The three plans of a vehicle, and what each accepts."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from math import isfinite, isinf
from typing import NamedTuple

from vehicle_sim.autopilot.plans.commands import COMMANDS, JUMP
from vehicle_sim.autopilot.plans.item import Item

GLOBAL_FRAMES = frozenset({0, 3, 5, 6, 10, 11})  # above sea, home or terrain; each with an old and an _INT number
TERRAIN_FRAMES = frozenset({10, 11})
ABOVE_HOME_FRAMES = frozenset({3, 6})


class Answer(IntEnum):
    """MAV_MISSION_RESULT."""

    ACCEPTED = 0
    ERROR = 1
    UNSUPPORTED_FRAME = 2
    UNSUPPORTED = 3
    NO_SPACE = 4
    INVALID_PARAM1 = 6
    INVALID_PARAM2 = 7
    INVALID_PARAM3 = 8
    INVALID_PARAM4 = 9
    INVALID_PARAM5_X = 10
    INVALID_PARAM6_Y = 11
    INVALID_PARAM7 = 12
    INVALID_SEQUENCE = 13
    DENIED = 14
    CANCELLED = 15


class FenceCommand(IntEnum):
    """What a fence is made of. A polygon's vertices follow each other, each saying in parameter 1 how many they are."""

    RETURN_POINT = 5000
    POLYGON_INCLUSION = 5001
    POLYGON_EXCLUSION = 5002
    CIRCLE_INCLUSION = 5003
    CIRCLE_EXCLUSION = 5004


RALLY_POINT = 5100


class Kind(NamedTuple):
    """One sort of plan.

    Attributes:
        number: MAV_MISSION_TYPE. name: as the texts say it. most: items that fit.
        total: the read-only parameter that counts them, if any. received: what is said when a new one has come.
        missing: the answer to a request beyond the last item. home_first: item 0 is home.
        flown: an item as it is flown, where that is not as it was sent.
    """

    number: int
    name: str
    most: int
    total: str | None
    accepts: Callable[[Item, int], Answer]
    received: str = ""
    missing: Answer = Answer.INVALID_SEQUENCE
    home_first: bool = False
    flown: Callable[[Item], Item] | None = None


def _mission_item(item: Item, count: int) -> Answer:
    row = COMMANDS.get(item.command)
    if row is None:
        return Answer.UNSUPPORTED
    for index, value in enumerate(item.params):
        if not isfinite(value) and (isinf(value) or index != 3 or not row.any_yaw):
            return Answer(Answer.INVALID_PARAM1 + index)
    if row.place and item.frame not in GLOBAL_FRAMES - TERRAIN_FRAMES:
        return Answer.UNSUPPORTED_FRAME
    if item.command == JUMP and not 0 < item.param1 < count:
        return Answer.ERROR
    return _place(item) if row.place else Answer.ACCEPTED if isfinite(item.z) else Answer.INVALID_PARAM7


def _fence_item(item: Item, count: int) -> Answer:
    if item.command not in FenceCommand.__members__.values():
        return Answer.UNSUPPORTED
    if item.frame not in GLOBAL_FRAMES:
        return Answer.UNSUPPORTED_FRAME
    if not 0.0 <= item.param1 <= 1e6:  # NaN compares false
        return Answer.INVALID_PARAM1
    return _place(item._replace(z=0.0))


def _rally_item(item: Item, count: int) -> Answer:
    if item.command != RALLY_POINT:
        return Answer.UNSUPPORTED
    if item.frame not in ABOVE_HOME_FRAMES:
        return Answer.UNSUPPORTED_FRAME
    return _place(item)


def _place(item: Item) -> Answer:
    if abs(item.x) > 900_000_000:
        return Answer.INVALID_PARAM5_X
    if abs(item.y) > 1_800_000_000:
        return Answer.INVALID_PARAM6_Y
    return Answer.ACCEPTED if abs(item.z) <= 32767.0 else Answer.INVALID_PARAM7  # NaN compares false


MISSION = Kind(
    0, "Mission", 724, "MIS_TOTAL", _mission_item, "Flight plan received", missing=Answer.ERROR, home_first=True
)
FENCE = Kind(1, "Fence", 84, "FENCE_TOTAL", _fence_item)
RALLY = Kind(2, "Rally", 20, "RALLY_TOTAL", _rally_item, "Rally points received")
KINDS: tuple[Kind, Kind, Kind] = (MISSION, FENCE, RALLY)


class Store:
    """One plan as it is kept.

    Attributes:
        items: as they were sent. flown: as they are flown. version: grows whenever they change.
    """

    def __init__(self, kind: Kind) -> None:
        self.kind = kind
        self.items: tuple[Item, ...] = ()
        self.flown: tuple[Item, ...] = ()
        self.version = 0

    def put(self, items: tuple[Item, ...]) -> None:
        self.items = items
        self.flown = items if self.kind.flown is None else tuple(map(self.kind.flown, items))
        self.version += 1


def polygons_closed(items: tuple[Item, ...]) -> bool:
    """Whether every polygon of a fence has three vertices or more and as many as its vertices say."""
    index = 0
    while index < len(items):
        item = items[index]
        if item.command not in (FenceCommand.POLYGON_INCLUSION, FenceCommand.POLYGON_EXCLUSION):
            index += 1
            continue
        corners = int(item.param1)
        polygon = items[index : index + corners]
        alike = all((corner.command, int(corner.param1)) == (item.command, corners) for corner in polygon)
        if corners < 3 or len(polygon) < corners or not alike:
            return False
        index += corners
    return True
