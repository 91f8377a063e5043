"""No input raises or moves it wrongly: every message type of the dialect, with any fields, with valid checksums."""

from __future__ import annotations

from math import hypot, isfinite
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import SYSTEM, flying, order, velocity
from vehicle_sim.autopilot.channel import BYTES_A_TICK

RANGES = {f"uint{bits}_t": (0, 2**bits - 1) for bits in (8, 16, 32, 64)}
RANGES |= {f"int{bits}_t": (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (8, 16, 32, 64)}
FLOATS = st.floats(width=32) | st.sampled_from([0.0, 1.0, -1.0, 4.0, 2989.0, 21196.0])
KNOWN = [20, 21, 22, 176, 178, 400, 410, 510, 511, 512]
OURS = [0, 11, 20, 21, 23, 66, 75, 76, 84, 86]


@st.composite
def messages(draw: st.DrawFn, ids: st.SearchStrategy[int]) -> Any:
    """Any message of the dialect with any fields, mostly for this vehicle."""
    kind = dialect.mavlink_map[draw(ids)]
    fields = []
    for name, wire, length in zip(kind.fieldnames, kind.fieldtypes, lengths_by_name(kind), strict=True):
        if name == "target_system":
            fields.append(draw(st.sampled_from([SYSTEM, 0])))
        elif name == "command" and wire == "uint16_t" and not length:
            fields.append(draw(st.sampled_from(KNOWN) | st.integers(0, 65535)))
        elif wire == "char":
            fields.append(draw(st.binary(max_size=max(1, length))))
        else:
            value = FLOATS if wire in ("float", "double") else st.integers(*RANGES[wire])
            fields.append(draw(st.lists(value, min_size=length, max_size=length) if length else value))
    return kind(*fields)


def lengths_by_name(kind: Any) -> list[int]:
    """Array lengths in field order (pymavlink keeps them in wire order)."""
    lengths = dict(zip(kind.ordered_fieldnames, kind.array_lengths, strict=True))
    return [lengths[name] for name in kind.fieldnames]


ANY_ID = st.sampled_from(sorted(dialect.mavlink_map))
OUR_ID = st.sampled_from(OURS)


@settings(max_examples=120, deadline=None)
@given(batch=st.lists(messages(OUR_ID) | messages(ANY_ID), min_size=1, max_size=12))
def test_no_message_breaks_it(batch: list[Any]) -> None:
    station = flying()
    before = station.vehicle.truth.position_ned_m
    for message in batch:
        station.tick(message)
    station.tick(seconds=1.0)
    truth = station.vehicle.truth
    assert all(isfinite(x) for x in (*truth.position_ned_m, *truth.velocity_ned_m_s, truth.yaw_rad, truth.roll_rad))
    moved_m = hypot(*(a - b for a, b in zip(truth.position_ned_m[:2], before[:2], strict=True)))
    assert moved_m <= 100.0 * 0.1 * (len(batch) + 10)  # no faster than the fastest speed a command can set
    assert truth.position_ned_m[2] <= 0.0
    assert station.tick(order(512, 148))  # still alive


@settings(max_examples=60, deadline=None)
@given(noise=st.binary(max_size=300))
def test_noise_on_the_line_moves_nothing(noise: bytes) -> None:
    station = flying()
    before = station.vehicle.truth.position_ned_m
    station.vehicle.tick(station.now_s + 0.1, noise)
    assert station.vehicle.truth.position_ned_m[:2] == before[:2]
    assert station.vehicle.truth.armed


def test_a_flood_is_cut_and_the_vehicle_flies_on() -> None:
    station = flying()
    for _ in range(3000):
        station.out.send(velocity(1.0))
    flood = station.out.take()
    assert len(flood) > BYTES_A_TICK
    station.vehicle.tick(station.now_s + 0.1, flood)
    assert 0 < station.vehicle.endpoint.received < 3000
    station.ticks += 1
    for _ in range(30):
        station.tick(velocity(1.0))
    assert station.vehicle.truth.velocity_ned_m_s[0] > 0.8


def test_time_that_stands_still_or_runs_back_changes_nothing() -> None:
    station = flying()
    truth = station.vehicle.truth
    station.vehicle.tick(station.now_s, b"")
    station.vehicle.tick(station.now_s - 5.0, b"")
    assert station.vehicle.truth == truth
