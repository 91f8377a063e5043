"""Hostile frames: any message type with any fields and a valid checksum, or bytes that only look like a frame."""

from __future__ import annotations

import struct
from collections.abc import Callable
from random import Random
from typing import NamedTuple

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint
from tests.fuzz.layouts import BAD_FLOATS, BY_NAME, GOOD_FLOATS, LAYOUTS, NAMES, PLACES, Field, Layout

HOME = GeoPoint(47.397742, 8.545594, 488.1)


class Sender(NamedTuple):
    """Who storms, and whom: source ids to choose from, target system, and the message types it prefers."""

    sources: tuple[tuple[int, int], ...]
    target: int
    favorites: tuple[Layout, ...]


ORDERS = tuple(BY_NAME[name] for name in ("COMMAND_LONG", "COMMAND_INT", "SET_POSITION_TARGET_LOCAL_NED",
               "SET_POSITION_TARGET_GLOBAL_INT", "SET_ATTITUDE_TARGET", "SET_MODE", "PARAM_SET", "MISSION_ITEM_INT",
               "MISSION_COUNT", "HEARTBEAT"))  # fmt: skip
REQUESTS = tuple(layout for layout in LAYOUTS if layout.addressed)
REPORTS = tuple(BY_NAME[name] for name in ("HEARTBEAT", "COMMAND_ACK", "PARAM_VALUE", "STATUSTEXT", "ATTITUDE",
                "LOCAL_POSITION_NED", "GLOBAL_POSITION_INT", "GPS_GLOBAL_ORIGIN", "SYS_STATUS", "BATTERY_STATUS",
                "EXTENDED_SYS_STATE", "EKF_STATUS_REPORT", "HOME_POSITION", "AUTOPILOT_VERSION"))  # fmt: skip


def storm_frame(rng: Random, sender: Sender) -> bytes:
    """One hostile thing to put on the wire."""
    dice = rng.random()
    if dice < 0.3:
        layout = rng.choice(sender.favorites)
    elif dice < 0.6:
        layout = rng.choice(REQUESTS)
    else:
        layout = rng.choice(LAYOUTS)
    wire = frame_of(rng, layout, sender)
    return rng.choice(DAMAGES)(rng, wire) if rng.random() < 0.12 else wire


def frame_of(rng: Random, layout: Layout, sender: Sender) -> bytes:
    """A frame of this type with a valid checksum. Its payload may be cut or too long, which the protocol allows."""
    payload = bytearray(rng.randbytes(layout.size))
    decent = rng.random() < 0.5  # a decent frame is all good values but perhaps one
    for field in layout.fields:
        _fill(rng, payload, field, sender, decent=decent and rng.random() > 0.1)
    length = rng.random()
    if length < 0.05:
        payload = payload[: rng.randint(1, len(payload))]
    elif length < 0.08:
        payload += rng.randbytes(rng.randint(0, 255 - len(payload)))
    return wrap(bytes(payload), layout, source=rng.choice(sender.sources), seq=rng.randrange(256))


def wrap(payload: bytes, layout: Layout, *, source: tuple[int, int], seq: int = 0) -> bytes:
    """A MAVLink 2 frame around `payload`, unsigned."""
    header = bytes((len(payload), 0, 0, seq, *source)) + layout.id.to_bytes(3, "little")
    return b"\xfd" + header + payload + _checksum(header + payload, layout.crc_extra)


def wrap_1(payload: bytes, layout: Layout, *, source: tuple[int, int]) -> bytes:
    """The same as a MAVLink 1 frame."""
    header = bytes((len(payload), 0, *source, layout.id & 0xFF))
    return b"\xfe" + header + payload + _checksum(header + payload, layout.crc_extra)


def _checksum(covered: bytes, crc_extra: int) -> bytes:
    return struct.pack("<H", dialect.x25crc(covered + bytes((crc_extra,))).crc)


def _fill(rng: Random, payload: bytearray, field: Field, sender: Sender, *, decent: bool) -> None:
    """Put something into one field; what is not touched stays random."""
    name, offset, code, count, choices = field
    if name == "target_system":
        payload[offset] = sender.target if rng.random() < 0.8 else rng.choice((0, 0, 255, rng.randrange(256)))
    elif code == "s":
        text = rng.choice(NAMES) if name == "param_id" else rng.randbytes(count)
        if decent or rng.random() < 0.5:
            struct.pack_into(f"{count}s", payload, offset, text)
    elif code in "fd":
        size = 4 if code == "f" else 8
        for index in range(count):
            struct.pack_into(f"<{code}", payload, offset + index * size, _float(rng, decent=decent))
    elif count == 1 and (decent or rng.random() < 0.6):
        value = rng.choice(choices)
        if decent and code == "i" and name in PLACES:
            home = HOME.latitude_deg if "lat" in name or name == "x" else HOME.longitude_deg
            value = round((home + rng.uniform(-1e-3, 1e-3)) * 1e7)
        struct.pack_into(f"<{code}", payload, offset, value)


def _float(rng: Random, *, decent: bool) -> float:
    dice = rng.random()
    if decent or dice < 0.3:
        return rng.choice(GOOD_FLOATS) if dice < 0.8 else rng.uniform(-50.0, 50.0)
    return rng.choice(BAD_FLOATS) if dice < 0.8 else struct.unpack("<f", rng.randbytes(4))[0]


def _flip(rng: Random, wire: bytes) -> bytes:
    broken = bytearray(wire)
    broken[rng.randrange(len(broken))] ^= 1 << rng.randrange(8)
    return bytes(broken)


def _cut(rng: Random, wire: bytes) -> bytes:
    return wire[: rng.randrange(len(wire))]


def _noise(rng: Random, wire: bytes) -> bytes:
    return rng.randbytes(rng.randrange(300)) + wire


def _stray(rng: Random, wire: bytes) -> bytes:
    return b"\xfd\xff" * rng.randint(1, 3) + wire


def _signed(rng: Random, wire: bytes) -> bytes:
    header = bytes((wire[1], 1)) + wire[3:10]
    layout = BY_ID.get(int.from_bytes(wire[7:10], "little"))
    crc = _checksum(header + wire[10:-2], layout.crc_extra if layout else 0)
    return b"\xfd" + header + wire[10:-2] + crc + rng.randbytes(13)


def _unknown(rng: Random, wire: bytes) -> bytes:
    return wire[:7] + rng.randrange(2**24).to_bytes(3, "little") + wire[10:]


def _flagged(rng: Random, wire: bytes) -> bytes:
    return wire[:2] + bytes((rng.randrange(256),)) + wire[3:]


def _old(rng: Random, wire: bytes) -> bytes:
    layout = BY_ID[int.from_bytes(wire[7:10], "little")]
    return wrap_1(wire[10:-2], layout, source=(wire[5], wire[6]))


def _twice(rng: Random, wire: bytes) -> bytes:
    return wire * rng.randint(2, 5)


BY_ID = {layout.id: layout for layout in LAYOUTS}
DAMAGES: tuple[Callable[[Random, bytes], bytes], ...] = (
    _flip, _cut, _noise, _stray, _signed, _unknown, _flagged, _old, _twice,
)  # fmt: skip
