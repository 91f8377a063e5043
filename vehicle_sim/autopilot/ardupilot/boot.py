"""Power-up to armable: what an ArduCopter says and knows at each moment, as recorded from 4.5.5 SITL in 41.16 s."""

from __future__ import annotations

from vehicle_sim.autopilot.boot import Script, Stage
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

ARDUCOPTER = Script(READY_S, TEXTS, STAGES)
