"""What MAV_CMD_INJECT_FAILURE breaks and mends, as the SIM_* parameter of the shared machine that does it."""

from __future__ import annotations

from enum import IntEnum


class Unit(IntEnum):
    """FAILURE_UNIT."""

    MAG = 2
    BARO = 3
    GPS = 4
    MOTOR = 101


class Failure(IntEnum):
    """FAILURE_TYPE."""

    OK = 0
    OFF = 1
    STUCK = 2


FAILURES: dict[tuple[Unit, Failure], tuple[str, float]] = {
    (Unit.GPS, Failure.OK): ("SIM_GPS_DISABLE", 0.0),
    (Unit.GPS, Failure.OFF): ("SIM_GPS_DISABLE", 1.0),
    (Unit.MAG, Failure.OK): ("SIM_MAG1_FAIL", 0.0),
    (Unit.MAG, Failure.OFF): ("SIM_MAG1_FAIL", 1.0),
    (Unit.BARO, Failure.OK): ("SIM_BARO_FREEZE", 0.0),
    (Unit.BARO, Failure.STUCK): ("SIM_BARO_FREEZE", 1.0),
    (Unit.MOTOR, Failure.OK): ("SIM_ENGINE_MUL", 1.0),
    (Unit.MOTOR, Failure.OFF): ("SIM_ENGINE_MUL", 0.0),
}
