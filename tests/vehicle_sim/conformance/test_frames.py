"""Frames beside recorded frames: the same bytes for the same message, and the same fields in the same state."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from comms.mavlink import Endpoint
from tests.vehicle_sim.autopilot.ground_station import GroundStation, flying, order, velocity

FRAMES: dict[str, str] = json.loads((Path(__file__).parent / "recordings" / "frames.json").read_text())
PLACE, CLOCK, NOISE = "where it was", "its clock", "estimator noise, which is off unless a SIM_ parameter asks for it"
# Fields that differ, and why. Of attitude, local position and system time nothing but the bytes is compared.
DIFFERENT: dict[str, dict[str, str]] = {
    "AUTOPILOT_VERSION": {
        "capabilities": "says no more than is there: no terrain, no flight information",
        "uid": "our system id: no two vehicles of a swarm are alike",
        "uid2": "the recorded one's board",
    },
    "EKF_STATUS_REPORT": {f"{name}_variance": NOISE for name in ("velocity", "pos_horiz", "pos_vert", "compass")},
    "GLOBAL_POSITION_INT": dict.fromkeys(("lat", "lon", "alt", "relative_alt", "vx", "vy", "hdg"), PLACE),
    "GPS_RAW_INT": dict.fromkeys(("lat", "lon", "alt", "alt_ellipsoid", "vel", "cog"), PLACE) | {"time_usec": CLOCK},
    "GPS_GLOBAL_ORIGIN": {"time_usec": CLOCK},
    "HOME_POSITION": {
        "altitude": "the recorded home was 4 cm below its origin",
        "z": "the recorded home was 4 cm below its origin",
        "q": "NaN is never equal",
        "time_usec": CLOCK,
    },
    "SYS_STATUS": {"current_battery": "28.0 A hovering, recorded 28.1 A", "battery_remaining": "how long it had flown"},
}
CLOCKS = {"time_boot_ms": CLOCK}
STATE = ("AUTOPILOT_VERSION", "EKF_STATUS_REPORT", "EXTENDED_SYS_STATE", "GLOBAL_POSITION_INT",
         "GPS_GLOBAL_ORIGIN", "GPS_RAW_INT", "HEARTBEAT", "HOME_POSITION",
         "POSITION_TARGET_LOCAL_NED", "SYS_STATUS")  # fmt: skip


def decoded(wire: str) -> Any:
    (message,) = Endpoint(system_id=255).receive(bytes.fromhex(wire))
    return message


@pytest.mark.parametrize("name", FRAMES)
def test_the_recorded_message_packs_to_the_recorded_bytes(name: str) -> None:
    wire = bytes.fromhex(FRAMES[name])
    end, message = Endpoint(system_id=1), decoded(FRAMES[name])
    fields = [getattr(message, field) for field in message.get_fieldnames()]
    fields = [field.encode() if isinstance(field, str) else field for field in fields]
    end.send(type(message)(*fields))
    ours = end.take()
    assert ours[5:-2] == wire[5:-2]  # but for the sequence number, which the checksum covers, too
    assert ours[:4] == wire[:4]


@pytest.fixture(scope="module")
def station() -> GroundStation:
    """As when the frames were recorded: 10 m up, flying north at 1 m/s by velocity setpoints."""
    station = flying()
    for _ in range(80):
        station.tick(velocity(1.0))
    return station


@pytest.mark.parametrize("name", STATE)
def test_the_same_state_is_told_in_the_same_fields(station: GroundStation, name: str) -> None:
    theirs = decoded(FRAMES[name])
    heard = station.tick(order(512, theirs.get_msgId()), velocity(1.0))
    ours = next(message for message in heard if message.get_type() == name)
    different = CLOCKS | DIFFERENT.get(name, {})
    for field in theirs.get_fieldnames():
        if field not in different:
            assert getattr(ours, field) == getattr(theirs, field), field
