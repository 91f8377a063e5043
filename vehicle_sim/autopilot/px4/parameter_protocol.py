"""PX4's parameter protocol: integers travel as their bytes in the float field, and a hash of all comes first."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from math import isfinite
from typing import Any
from zlib import crc32

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.parameters import REAL32
from vehicle_sim.autopilot.px4.commander import Commander

HASH, UINT32 = "_HASH_CHECK", 5
UNKNOWN_INDEX = 65535
DOES_NOT_EXIST, VALUE_OUT_OF_RANGE, READ_ONLY = 1, 2, 3  # MAV_PARAM_ERROR


def listed(pilot: Commander, message: Any) -> Iterator[Any]:
    """Every parameter, behind the hash by which a ground station knows whether it has them already."""
    yield _hash(pilot)
    for index in range(len(pilot.parameters.catalog.rows)):
        yield _value(pilot, index)


def read(pilot: Commander, message: Any) -> Iterator[Any]:
    """One parameter, by its index or (index -1) by its name."""
    catalog = pilot.parameters.catalog
    index = catalog.index.get(message.param_id, -1) if message.param_index < 0 else message.param_index
    if message.param_index < 0 and message.param_id == HASH:
        yield _hash(pilot)
    elif 0 <= index < len(catalog.rows):
        yield _value(pilot, index)
    else:
        yield _error(message, message.param_index, DOES_NOT_EXIST)


def written(pilot: Commander, message: Any) -> Iterator[Any]:
    """Set one, and answer with what is stored now. Setting the hash stops a list, which here is over at once."""
    catalog, name = pilot.parameters.catalog, message.param_id
    if name == HASH:
        return
    if name not in catalog.index:
        yield _error(message, -1, DOES_NOT_EXIST)
        return
    row = catalog.rows[catalog.index[name]]
    value = message.param_value if row.type == REAL32 else float(_integer(message.param_value))
    if row.read_only:
        yield _error(message, -1, READ_ONLY)
        return
    if not isfinite(value):
        yield _error(message, -1, VALUE_OUT_OF_RANGE)
        return
    pilot.parameters.store(name, value)
    yield _value(pilot, catalog.index[name])


def _value(pilot: Commander, index: int) -> Any:
    row = pilot.parameters.catalog.rows[index]
    return dialect.MAVLink_param_value_message(
        row.name.encode(), _wired(pilot, index), row.type, len(pilot.parameters.catalog.rows), index
    )


def _wired(pilot: Commander, index: int) -> float:
    """The value as the float field carries it."""
    row = pilot.parameters.catalog.rows[index]
    value = pilot.parameters[row.name]
    return value if row.type == REAL32 else _bits("<i", int(value))


def _hash(pilot: Commander) -> Any:
    """Of all names and values, in the order of the list."""
    rows = pilot.parameters.catalog.rows
    digest = 0
    for index, row in enumerate(rows):
        digest = crc32(struct.pack("<f", _wired(pilot, index)), crc32(row.name.encode(), digest))
    return dialect.MAVLink_param_value_message(HASH.encode(), _bits("<I", digest), UINT32, len(rows), UNKNOWN_INDEX)


def _bits(form: str, number: int) -> float:
    return float(struct.unpack("<f", struct.pack(form, number))[0])


def _integer(field: float) -> int:
    """The integer in a float field."""
    return int(struct.unpack("<i", struct.pack("<f", field))[0])


def _error(message: Any, index: int, error: int) -> Any:
    name = str(message.param_id).encode(errors="replace")[:16]
    return dialect.MAVLink_param_error_message(message.get_srcSystem(), message.get_srcComponent(), name, index, error)
