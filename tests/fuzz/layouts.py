"""How each message type of the dialect lies on the wire, and what is worth trying in each of its fields."""

from __future__ import annotations

import re
import struct
from math import inf, nan
from typing import Any, NamedTuple

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.ardupilot.commands import COMMANDS
from vehicle_sim.autopilot.ardupilot.parameters import TABLE
from vehicle_sim.autopilot.px4.commands import COMMANDS as PX4_COMMANDS
from vehicle_sim.autopilot.px4.modes import Mode as Px4Mode
from vehicle_sim.autopilot.px4.parameters import ROWS

SIZES = {"b": 8, "B": 8, "h": 16, "H": 16, "i": 32, "I": 32, "q": 64, "Q": 64}
# Numbers that break arithmetic, and numbers that mean something: magic words, message ids, modes, heights.
BAD_FLOATS = (nan, inf, -inf, 3.4e38, -3.4e38, 1e30, -1e9, 1e9, 1e-42, -0.0, 2.0**31, 2.0**32, -(2.0**31), 1e6)
GOOD_FLOATS = (0.0, 1.0, -1.0, 2.0, 3.0, 4.0, 6.0, 9.0, 10.0, 17.0, 21.0, 0.5, 30.0, 32.0, 33.0, 100.0, 148.0, 242.0,
               1000.0, 100_000.0, 1_000_000.0, 2989.0, 21196.0, 290876.0, 65535.0)  # fmt: skip
MODES = (*range(30), *map(int, Px4Mode))
MASKS = (0xDC7, 0x9C7, 0x5C7, 0xDF8, 0x9F8, 0xFC0, 0xFFF, 0x000, 0xE07, 0x1C0)
SMALL = (0, 1, 2, 3, 4, 5, 7, 10, 50, 200, 718, 719, 1000, 1364)
NAMES = tuple(row.name.encode() for row in (*TABLE, *ROWS))
# Field names whose good values the dialect does not tell.
KNOWN: dict[str, tuple[int, ...]] = {
    "custom_mode": MODES,
    "type_mask": MASKS,
    "seq": SMALL,
    "count": SMALL,
    "param_index": (*SMALL, -1, -2, -32768),
    "start_index": SMALL,
    "end_index": (*SMALL, -1),
    "current": (0, 1, 2, 3),
    "req_stream_id": tuple(range(14)),
    "req_message_rate": (0, 1, 4, 10, 50, 65535),
    "start_stop": (0, 1),
    "chunk_seq": (0, 1, 2, 255),
    "id": (0, 1, 2, 255),
}
PLACES = frozenset({"x", "y", "lat", "lon", "lat_int", "lon_int", "latitude", "longitude"})


class Field(NamedTuple):
    """One field, or array: where it lies, its `struct` code, how many there are, and the integers worth trying."""

    name: str
    offset: int
    code: str
    count: int
    choices: tuple[int, ...]


class Layout(NamedTuple):
    """One message type on the wire."""

    name: str
    id: int
    crc_extra: int
    size: int
    fields: tuple[Field, ...]

    @property
    def addressed(self) -> bool:
        """It has a target: a request to a vehicle."""
        return any(field.name == "target_system" for field in self.fields)


def layout_of(kind: Any) -> Layout:
    fields: list[Field] = []
    offset = 0
    codes = re.findall(r"(\d*)([a-zA-Z])", kind.unpacker.format.lstrip("<"))
    for name, (count, code) in zip(kind.ordered_fieldnames, codes, strict=True):
        fields.append(Field(name, offset, code, int(count or 1), _choices(kind, name, code)))
        offset += struct.calcsize(f"<{count}{code}")
    return Layout(kind.msgname, int(kind.id), int(kind.crc_extra), offset, tuple(fields))


def _choices(kind: Any, name: str, code: str) -> tuple[int, ...]:
    """The integers worth trying: what the field's enum lists and its neighbors, and the ends of its range."""
    bits = SIZES.get(code)
    if bits is None:
        return ()
    low, high = (0, 2**bits - 1) if code.isupper() else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    enum = kind.fieldenums_by_name.get(name)
    listed = tuple(dialect.enums.get(enum, ())) if enum else ()
    if name == "command":
        listed = (*(*COMMANDS, *PX4_COMMANDS) * 8, *listed)
    near = tuple(value + 1 for value in listed[-2:])
    wanted = (*KNOWN.get(name, ()), *listed, *near, 0, 1, low, high, high // 2)
    return tuple(value for value in wanted if low <= value <= high)


LAYOUTS: tuple[Layout, ...] = tuple(layout_of(dialect.mavlink_map[number]) for number in sorted(dialect.mavlink_map))
BY_NAME = {layout.name: layout for layout in LAYOUTS}
