"""Power-up to armable: what an ArduCopter says and knows at each moment, as recorded from 4.5.5 SITL.

The real sequence takes 41.16 s; a vehicle may boot faster, in the same order and with the same texts.
"""

from __future__ import annotations

from bisect import bisect_right
from typing import NamedTuple

from vehicle_sim.vehicle import READY_S as READY

READY_S = READY["ardupilot"]

# (real seconds after power-on, text); all are of severity INFO.
TEXTS: tuple[tuple[float, str], ...] = (
    (0.06, "Calibrating barometer"),
    (1.66, "Barometer 1 calibration complete"),
    (1.66, "Barometer 2 calibration complete"),
    (2.21, "ArduPilot Ready"),
    (2.21, "AHRS: DCM active"),
    (2.48, "RC7: SaveWaypoint LOW"),
    (4.19, "EKF3 IMU0 initialised"),
    (4.19, "EKF3 IMU1 initialised"),
    (4.19, "AHRS: EKF3 active"),
    (5.53, "EKF3 IMU0 tilt alignment complete"),
    (5.53, "EKF3 IMU1 tilt alignment complete"),
    (5.63, "EKF3 IMU0 MAG0 initial yaw alignment complete"),
    (5.63, "EKF3 IMU1 MAG0 initial yaw alignment complete"),
    (9.54, "GPS 1: detected as u-blox at 230400 baud"),
    (19.76, "EKF3 IMU0 origin set"),
    (19.79, "Field Elevation Set: {field_elevation_m:.0f}m"),
    (19.95, "EKF3 IMU1 origin set"),
    (41.16, "EKF3 IMU0 is using GPS"),
    (41.36, "EKF3 IMU1 is using GPS"),
)


class Stage(NamedTuple):
    """What the autopilot knows from a moment on.

    Attributes:
        from_s: real seconds after power-on. ekf_flags: EKF_STATUS_REPORT.flags.
        gps_fix, satellites: GPS_RAW_INT. gps_wrong: the first fix is half a degree off.
        origin: the EKF has its origin, home is set. position: the EKF uses GPS, LOCAL_POSITION_NED flows.
        complaints: reasons not to arm.
    """

    from_s: float
    ekf_flags: int
    complaints: tuple[str, ...] = ()
    booting: bool = False
    gps_fix: int = 0
    satellites: int = 0
    gps_wrong: bool = False
    origin: bool = False
    position: bool = False


NEED_POSITION = "Need Position Estimate"  # only a mode that needs a position cares
_COLD = ("Accels inconsistent", "EKF attitude is bad", "Compass not healthy", "AHRS: EKF3 not started")
_ACCELS = ("Accels inconsistent", "AHRS: waiting for home")
_GYROS = ("Gyros inconsistent", "AHRS: waiting for home")

STAGES: tuple[Stage, ...] = (
    Stage(0.0, 1024, _COLD, booting=True),
    Stage(2.21, 1024, _COLD),
    Stage(4.19, 0, ("Accels inconsistent", "EKF attitude is bad", "AHRS: waiting for home")),
    Stage(5.53, 167, _ACCELS),
    Stage(9.54, 167, _ACCELS, gps_fix=1, satellites=3, gps_wrong=True),
    Stage(9.8, 167, _ACCELS, gps_fix=6, satellites=10),
    Stage(12.8, 167, _GYROS, gps_fix=6, satellites=10),
    Stage(19.76, 167, ("Gyros inconsistent", NEED_POSITION), gps_fix=6, satellites=10, origin=True),
    Stage(23.3, 167, (NEED_POSITION,), gps_fix=6, satellites=10, origin=True),
    Stage(READY_S, 831, gps_fix=6, satellites=10, origin=True, position=True),
)


class Script(NamedTuple):
    """How a kind of autopilot boots: its texts and stages, in order, and when it is ready to arm."""

    ready_s: float
    texts: tuple[tuple[float, str], ...]
    stages: tuple[Stage, ...]


ARDUCOPTER = Script(READY_S, TEXTS, STAGES)


class Boot:
    """One vehicle's boot sequence, scaled to `boot_s`. It only ever goes forward."""

    def __init__(self, script: Script, *, boot_s: float, field_elevation_m: float) -> None:
        scale = boot_s / script.ready_s
        self._texts = [(at_s * scale, text.format(field_elevation_m=field_elevation_m)) for at_s, text in script.texts]
        self._stages = script.stages
        self._starts_s = [stage.from_s * scale for stage in script.stages]
        self.restart()

    def restart(self) -> None:
        """Power-on, again."""
        self._said = 0
        self.stage = self._stages[0]

    def advance(self, age_s: float) -> list[str]:
        """Go on to `age_s` seconds after power-on; the texts that are due, in order."""
        if self._said == len(self._texts):
            return []
        self.stage = self._stages[max(0, bisect_right(self._starts_s, age_s + 1e-9) - 1)]
        due: list[str] = []
        while self._said < len(self._texts) and self._texts[self._said][0] <= age_s + 1e-9:
            due.append(self._texts[self._said][1])
            self._said += 1
        return due
