"""What the vehicle says and when: the same orders at the same times as in the recording, and the same texts."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import GUIDED, LAND, SYSTEM, GroundStation, flying, order
from vehicle_sim.vehicle import VehicleConfig

RECORDINGS = Path(__file__).parent / "recordings"
LATE_S = 0.25  # our texts leave with a tick of 0.1 s, and the recorded moments are those of arrival
TRIES_S = (6.03, 7.53, 9.03, 10.54, 12.04, 13.55, 15.06, 16.57, 18.08, 19.58, 21.08, 22.59, 24.09, 25.60, 27.10, 28.61,
           30.11, 31.62, 33.12, 34.62, 36.13, 37.64, 39.14, 40.65, 42.15)  # fmt: skip


class Line(NamedTuple):
    """One text."""

    at_s: float
    severity: int
    text: str


def recorded(name: str) -> list[Line]:
    lines = (RECORDINGS / f"{name}.txt").read_text().splitlines()
    return [
        Line(float(at_s), int(severity), text) for at_s, severity, text in (line.split(maxsplit=2) for line in lines)
    ]


def said(station: GroundStation, *, since_s: float = 0.0) -> list[Line]:
    texts = station.all("STATUSTEXT")
    return [Line(at_s - since_s, message.severity, message.text) for at_s, message in texts if at_s > since_s]


def replay(station: GroundStation, orders: list[tuple[float, Any]], *, seconds: float) -> None:
    """Send each message at its time, counted from now."""
    began = station.ticks
    for at_s, message in orders:
        station.tick(seconds=max(0.0, at_s - (station.ticks - began) * 0.1))
        station.tick(message)
    station.tick(seconds=seconds - (station.ticks - began) * 0.1)


def parameter(name: str, value: float) -> Any:
    return dialect.MAVLink_param_set_message(SYSTEM, 1, name.encode(), value, 9)


def assert_same(ours: list[Line], theirs: list[Line], *, late_s: float = LATE_S) -> None:
    """The same texts, each within `late_s` of its time: neighbors that are nearer may change places."""
    by_text = [sorted(lines, key=lambda line: (line.text, line.at_s)) for lines in (ours, theirs)]
    assert [line[1:] for line in by_text[0]] == [line[1:] for line in by_text[1]]
    for mine, real in zip(*by_text, strict=True):
        assert mine.at_s == pytest.approx(real.at_s, abs=late_s), (mine, real)


def test_power_up_25_tries_to_arm_and_ten_idle_seconds() -> None:
    """From power-on to armed and, left alone, disarmed again: 58 texts."""
    station = GroundStation(VehicleConfig(boot_s=41.16))
    replay(station, [(6.0, order(176, 1, GUIDED)), *((at_s, order(400, 1)) for at_s in TRIES_S)], seconds=53.0)
    assert_same(said(station), recorded("boot_and_arm"))


def test_landing_says_how_hard_and_disarms() -> None:
    theirs = recorded("landing")
    station = flying(altitude_m=6.29)
    began_s = station.now_s
    station.tick(order(176, 1, LAND), seconds=20.0)
    ours = said(station, since_s=began_s)
    assert [line.text.split(" at ")[0] for line in ours] == [line.text.split(" at ")[0] for line in theirs]
    assert float(ours[0].text.split()[4]) == pytest.approx(float(theirs[0].text.split()[4]), abs=0.03)
    for mine, real in zip(ours, theirs, strict=True):
        assert mine.at_s == pytest.approx(real.at_s - 110.857, abs=LATE_S)


def test_ground_station_lost_gps_lost_motors_off() -> None:
    """Seconds of the recording's boot clock: the last heartbeat of the ground station was 5 s before its failsafe.

    Between them it was in LAND twice, for 2.0 and 2.5 s, and never sank: a failsafe's landing begins with a pause.
    GUIDED was asked for at 84.23, just after the change to LAND; here that takes a tick or two more.
    """
    began_s = 69.0
    beat = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    orders = [
        (69.0, parameter("FS_GCS_ENABLE", 5)), (69.0, beat), (75.0, beat), (76.1, parameter("FS_GCS_ENABLE", 0)),
        (76.1, order(176, 1, GUIDED)), (76.1, parameter("SIM_GPS_DISABLE", 1)), (84.4, order(176, 1, GUIDED)),
        (85.2, parameter("SIM_GPS_DISABLE", 0)), (85.7, order(176, 1, GUIDED)), (86.7, order(176, 1, GUIDED)),
        (87.7, order(400, 0, 21196)),
    ]  # fmt: skip
    station = flying()
    at_s = station.now_s - began_s
    replay(station, [(when_s - began_s, message) for when_s, message in orders], seconds=21.0)
    ours = [line for line in said(station, since_s=at_s) if line.at_s > began_s]
    theirs = recorded("failsafes_and_fall")
    *ours, hit = ours
    *theirs, their_hit = theirs
    assert_same(ours, theirs, late_s=0.5)  # when GPS came back is known to half a second
    assert hit.at_s == pytest.approx(their_hit.at_s, abs=LATE_S)
    assert float(hit.text.split()[4]) == pytest.approx(float(their_hit.text.split()[4]), abs=0.5)
