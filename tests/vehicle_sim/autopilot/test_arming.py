"""Arming checks: what is wrong is said, in ArduCopter's words, and can be switched off bit by bit."""

from __future__ import annotations

import pytest

from tests.vehicle_sim.autopilot.ground_station import ready
from tests.vehicle_sim.autopilot.test_estimate import set_params

PREARM = 0x10000000

# (parameters, how long they last, the complaint, its bit of ARMING_CHECK; 0: it cannot be switched off)
CASES = [
    ({"SIM_GPS_DISABLE": 1.0}, 1.0, "GPS 1: Bad fix", 8),
    ({"SIM_GPS_DISABLE": 1.0}, 10.0, "Need Position Estimate", 0),
    ({"SIM_GPS_GLITCH_X": 0.001}, 5.0, "GPS glitching", 0),
    ({"SIM_MAG1_FAIL": 1.0}, 1.0, "Compass not healthy", 4),
    ({"SIM_BATT_VOLTAGE": 10.0}, 1.0, "Battery 1 low voltage failsafe", 256),
    ({"BATT_ARM_VOLT": 13.0}, 1.0, "Battery 1 below minimum arming voltage", 256),
    ({"BATT_ARM_MAH": 6000.0}, 1.0, "Battery 1 below minimum arming capacity", 256),
    ({"BATT_CRT_VOLT": 11.0}, 1.0, "Battery 1 voltage failsafe critical > low", 256),
    ({"ANGLE_MAX": 50.0}, 1.0, "Check ANGLE_MAX", 32),
]


@pytest.mark.parametrize(("values", "seconds", "complaint", "bit"), CASES)
def test_each_check_refuses_in_its_own_words(
    values: dict[str, float], seconds: float, complaint: str, bit: int
) -> None:
    station = ready()
    station.stream(1)
    assert station.last("SYS_STATUS").onboard_control_sensors_health & PREARM
    set_params(station, **values)
    station.tick(seconds=seconds)
    assert not station.last("SYS_STATUS").onboard_control_sensors_health & PREARM
    assert station.order(400, 1) == 4
    assert station.texts()[-1] == f"Arm: {complaint}"
    set_params(station, ARMING_CHECK=float(0x1FFFFE & ~bit))  # every check but this one
    assert station.order(400, 1) == (0 if bit else 4)


def test_the_reminder_comes_every_thirty_seconds() -> None:
    station = ready()
    set_params(station, SIM_MAG1_FAIL=1.0)
    station.tick(seconds=95.0)
    times = [at_s for at_s, text in station.all("STATUSTEXT") if text.text == "PreArm: Compass not healthy"]
    assert times == pytest.approx([30.0, 60.0, 90.0], abs=0.11)
