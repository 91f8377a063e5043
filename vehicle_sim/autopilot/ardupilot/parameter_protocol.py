"""The parameter protocol: PARAM_REQUEST_LIST, PARAM_REQUEST_READ and PARAM_SET in, PARAM_VALUE and PARAM_ERROR out."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.ardupilot.parameters import ALIASES, INDEX, TABLE
from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.parameters import REAL32
from vehicle_sim.autopilot.severity import WARNING

UNKNOWN_INDEX = 65535
DOES_NOT_EXIST, VALUE_OUT_OF_RANGE = 1, 2  # MAV_PARAM_ERROR


def listed(pilot: Autopilot, message: Any) -> Iterator[Any]:
    """Every parameter, under the names of 4.5."""
    for index in range(len(TABLE)):
        yield _value(pilot, index, listed=True)


def read(pilot: Autopilot, message: Any) -> Iterator[Any]:
    """One parameter, by its index or (index -1) by its name."""
    index = INDEX.get(message.param_id, -1) if message.param_index < 0 else message.param_index
    if message.param_index < 0 and message.param_id in ALIASES:
        yield _alias_value(pilot, message.param_id)
    elif 0 <= index < len(TABLE):
        yield _value(pilot, index, listed=True)
    else:
        yield _error(message, message.param_index, DOES_NOT_EXIST)


def written(pilot: Autopilot, message: Any) -> Iterator[Any]:
    """Set one, and answer with what is stored now; a read-only one stays and a text says so."""
    name, value = message.param_id, message.param_value
    alias = ALIASES.get(name)
    if alias is None and name not in INDEX:
        yield _error(message, -1, DOES_NOT_EXIST)
        return
    if not isfinite(value):
        yield _error(message, -1, VALUE_OUT_OF_RANGE)
        return
    if alias is not None:
        stored = pilot.parameters.store(alias.name, alias.scale * value + alias.offset)
    else:
        stored = pilot.parameters.store(name, value)
    if not stored:
        pilot.say(WARNING, f"Param write denied ({name})")
    yield _value(pilot, INDEX[name], listed=False) if alias is None else _alias_value(pilot, name)


def _value(pilot: Autopilot, index: int, *, listed: bool) -> Any:
    row = TABLE[index]
    return dialect.MAVLink_param_value_message(
        row.name.encode(), pilot.parameters[row.name], row.type, len(TABLE), index if listed else UNKNOWN_INDEX
    )


def _alias_value(pilot: Autopilot, name: str) -> Any:
    alias = ALIASES[name]
    value = (pilot.parameters[alias.name] - alias.offset) / alias.scale
    kind = TABLE[INDEX[alias.name]].type if abs(alias.scale) == 1.0 else REAL32
    return dialect.MAVLink_param_value_message(name.encode(), value, kind, len(TABLE), UNKNOWN_INDEX)


def _error(message: Any, index: int, error: int) -> Any:
    name = str(message.param_id).encode(errors="replace")[:16]
    return dialect.MAVLink_param_error_message(message.get_srcSystem(), message.get_srcComponent(), name, index, error)
