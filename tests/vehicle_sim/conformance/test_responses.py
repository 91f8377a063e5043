"""Motion beside the recorded motion: the same order at the same moment, and how far apart the two are from then on."""

from __future__ import annotations

import csv
from collections.abc import Callable
from math import nan, sqrt
from pathlib import Path
from typing import Any

import pytest

from tests.vehicle_sim.autopilot.ground_station import (
    LAND,
    TICK_S,
    GroundStation,
    flying,
    order,
    position,
    ready,
    velocity,
)

RECORDINGS = Path(__file__).parent / "recordings"
FIELDS = {"x": 0, "y": 1, "z": 2, "vx": 3, "vy": 4, "vz": 5}
Orders = Callable[[], list[Any]]  # what is sent in one tick


def recorded(name: str) -> tuple[list[str], list[list[float]]]:
    """The fields of an excerpt and their values, a row each 0.1 s."""
    with (RECORDINGS / f"{name}.csv").open() as lines:
        header, *rows = csv.reader(lines)
    return header[1:], [[float(value) for value in row[1:]] for row in rows]


def flown(
    station: GroundStation, fields: list[str], ticks: int, first: list[Any], then: list[Any]
) -> list[list[float]]:
    """Send `first`, then `then` each tick, and note the true motion as the recording does."""
    rows = [_row(station, fields)]
    for tick in range(ticks):
        station.tick(*(first if tick == 0 else then))
        rows.append(_row(station, fields))
    return rows


def _row(station: GroundStation, fields: list[str]) -> list[float]:
    truth = station.vehicle.truth
    numbers = (*truth.position_ned_m, *truth.velocity_ned_m_s)
    return [numbers[FIELDS[field]] for field in fields]


def armed() -> GroundStation:
    station = ready()
    assert station.order(400, 1) == 0
    return station


def cruising(north_m_s: float, *, seconds: float = 8.0) -> GroundStation:
    station = flying()
    for _ in range(round(seconds / TICK_S)):
        station.tick(velocity(north_m_s))
    return station


def high() -> GroundStation:
    """Where the recorded one was when it was sent home: 121.3 m north, 7.9 m east, 29.6 m up, at rest."""
    station = flying()
    station.tick(position(121.298, 7.928, -29.601), seconds=60.0)
    return station


def at_six_meters() -> GroundStation:
    return flying(altitude_m=6.29)


def steady(message: Any) -> tuple[list[Any], list[Any]]:
    """A setpoint that is sent every tick."""
    return [message], [message]


def once(message: Any) -> tuple[list[Any], list[Any]]:
    return [message], []


# Excerpt, how ours gets to where the recorded one was, what both are sent, and for each field the band: the greatest
# root mean square and the greatest single deviation over the whole excerpt (m, m/s). Positions count from the start.
# docs/conformance.md has these numbers, and says why the fifth and the sixth are wide.
CASES: list[tuple[str, Callable[[], GroundStation], tuple[list[Any], list[Any]], dict[str, tuple[float, float]]]] = [
    ("takeoff_to_10_m", armed, once(order(22, 0, 0, 0, 0, 0, 0, 10)), {"z": (0.3, 0.5), "vz": (0.2, 0.6)}),
    ("velocity_0_to_3_m_s", flying, steady(velocity(3.0)), {"x": (0.2, 0.3), "vx": (0.06, 0.2)}),
    ("setpoints_stop_at_3_m_s", lambda: cruising(3.0), ([], []), {"x": (0.2, 0.3), "vx": (0.06, 0.2)}),
    ("velocity_0_to_15_m_s", flying, steady(velocity(15.0)), {"x": (1.0, 1.5), "vx": (0.2, 0.4)}),
    ("velocity_10_to_0_m_s", lambda: cruising(15.0), steady(velocity(0.0)), {"x": (8.0, 12.0), "vx": (2.5, 3.5)}),
    ("position_120_m_away", high, once(position(0, 0, -10)), {"x": (3.5, 6.0), "y": (0.3, 0.5), "z": (0.7, 1.5)}),
    ("land_from_6_m", at_six_meters, once(order(176, 1, LAND)), {"z": (0.05, 0.1), "vz": (0.05, 0.15)}),
    ("motors_off_at_10_m", flying, once(order(400, 0, 21196)), {"z": (0.2, 0.35), "vz": (0.5, 0.8)}),
]


@pytest.mark.parametrize(("name", "start", "orders", "bands"), CASES, ids=[case[0] for case in CASES])
def test_motion_is_the_recorded_motion_within_its_band(
    name: str,
    start: Callable[[], GroundStation],
    orders: tuple[list[Any], list[Any]],
    bands: dict[str, tuple[float, float]],
) -> None:
    fields, theirs = recorded(name)
    ours = flown(start(), fields, len(theirs) - 1, *orders)
    for column, field in enumerate(fields):
        from_start = not field.startswith("v")
        gaps = [
            (mine[column] - from_start * ours[0][column]) - (real[column] - from_start * theirs[0][column])
            for mine, real in zip(ours, theirs, strict=True)
        ]
        rms, worst = sqrt(sum(gap * gap for gap in gaps) / len(gaps)), max(map(abs, gaps))
        assert rms <= bands[field][0], (field, rms, worst)
        assert worst <= bands[field][1], (field, rms, worst)


REVERSAL = (5.04, 4.58, 3.31, 2.09, 0.84, -0.47, -1.78, -3.07, -4.24, -4.75, -4.98, -5.04, -5.07)  # m/s, each 0.5 s


def test_a_reversal_from_5_to_minus_5_m_s_takes_as_long() -> None:
    station = cruising(5.0)
    ours = flown(station, ["vx"], 60, *steady(velocity(-5.0)))
    assert max(abs(ours[5 * k][0] - speed) for k, speed in enumerate(REVERSAL)) < 0.3


@pytest.mark.parametrize("bad", [velocity(nan), velocity(2.0, frame=99), velocity(2.0, mask=0xFFF)])
def test_a_bad_setpoint_stops_it_as_fast(bad: Any) -> None:
    """Recorded for NaN, frame 99 and mask 0xFFF alike, from 2 m/s, each half second."""
    ours = flown(cruising(2.0), ["vx"], 30, *steady(bad))
    assert max(abs(ours[5 * k][0] - v) for k, v in enumerate((1.96, 1.56, 0.52, 0.17, 0.05, -0.01, -0.03))) < 0.2


def test_a_fall_from_10_m_hits_the_ground_as_hard() -> None:
    station = flying()
    station.order(400, 0, 21196)
    station.tick(seconds=2.0)
    hit = next(text for text in station.texts() if text.startswith("SIM Hit ground at"))
    assert float(hit.split()[4]) == pytest.approx(11.75, abs=0.6)
