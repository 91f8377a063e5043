"""What a vehicle's sensors get wrong: the error of each reading, as a pure function of the faults, the place and time.

Without faults every sensor tells the truth. Noise is drawn from `comms.chance` and held for one sample, so that a
reading does not depend on who asked before.
"""

from __future__ import annotations

from math import atan2, cos, sin
from typing import NamedTuple

from comms.chance import BARO_NOISE, COMPASS_NOISE, GPS_NOISE, IMU_NOISE, draw
from comms.frames import Vec3
from vehicle_sim.flight import Motion, wrap_pi

LEAST_SATELLITES = 6
GPS_HZ, BARO_HZ, COMPASS_HZ, IMU_HZ = 5, 10, 10, 20  # how often a reading is a new one
EARTH_FIELD_MGAUSS = (215.0, 0.0, 430.0)  # north, east, down; without declination, as the heading is a true one


class Faults(NamedTuple):
    """What is wrong with the sensors of one vehicle; by default nothing.

    Attributes:
        gps_error_ned_m, gps_velocity_error_ne_m_s: added to what the GPS says.
        accel_error_frd_m_s2, gyro_yaw_error_rad_s: bias of the inertial sensors; forward, right, down.
        baro_error_m, baro_drift_m_s: upwards. baro_stuck: the barometer keeps its last reading.
        compass_offset_fr_mgauss: a field of the airframe that no calibration takes away; forward, right.
        anomaly_ne_mgauss: a field of the ground; at `anomaly_height_m` an eighth of it is left.
        *_noise: the largest deviation of a reading, on each axis.
    """

    gps_lost: bool = False
    satellites: int = 10
    gps_error_ned_m: Vec3 = (0.0, 0.0, 0.0)
    gps_velocity_error_ne_m_s: tuple[float, float] = (0.0, 0.0)
    gps_noise_m: float = 0.0
    accel_error_frd_m_s2: Vec3 = (0.0, 0.0, 0.0)
    accel_noise_m_s2: float = 0.0
    gyro_yaw_error_rad_s: float = 0.0
    gyro_noise_rad_s: float = 0.0
    baro_error_m: float = 0.0
    baro_drift_m_s: float = 0.0
    baro_noise_m: float = 0.0
    baro_stuck: bool = False
    compass_dead: bool = False
    compass_offset_fr_mgauss: tuple[float, float] = (0.0, 0.0)
    compass_noise_mgauss: float = 0.0
    anomaly_ne_mgauss: tuple[float, float] = (0.0, 0.0)
    anomaly_height_m: float = 1.0


NONE = Faults()


class Sensors:
    """The sensors of one vehicle that moves as `motion` does."""

    def __init__(self, *, motion: Motion, seed: int, who: int) -> None:
        self.faults = NONE
        self._motion = motion
        self._seed = seed
        self._who = who
        self._since_s = 0.0
        self._stuck_down_m = 0.0

    def set_faults(self, faults: Faults, now_s: float) -> None:
        """From now on. A drift begins and a reading sticks when it is first asked for. No faults are `NONE` itself."""
        if faults.baro_drift_m_s != self.faults.baro_drift_m_s:
            self._since_s = now_s
        if faults.baro_stuck and not self.faults.baro_stuck:
            self._stuck_down_m = self._motion.down_m
        self.faults = NONE if faults == NONE else faults

    @property
    def has_fix(self) -> bool:
        return not self.faults.gps_lost and self.faults.satellites >= LEAST_SATELLITES

    def gps_error_ned_m(self, now_s: float) -> Vec3:
        north, east, down = self.faults.gps_error_ned_m
        noise_m = self.faults.gps_noise_m
        if noise_m == 0.0:
            return north, east, down
        sample = int(now_s * GPS_HZ)
        north += noise_m * self._noise(sample, 0, GPS_NOISE)
        east += noise_m * self._noise(sample, 1, GPS_NOISE)
        return north, east, down + noise_m * self._noise(sample, 2, GPS_NOISE)

    def baro_error_m(self, now_s: float) -> float:
        """Upwards."""
        faults = self.faults
        if faults.baro_stuck:
            return self._motion.down_m - self._stuck_down_m
        error_m = faults.baro_error_m + faults.baro_drift_m_s * (now_s - self._since_s)
        if faults.baro_noise_m > 0.0:
            error_m += faults.baro_noise_m * self._noise(int(now_s * BARO_HZ), 0, BARO_NOISE)
        return error_m

    def accel_error_ned_m_s2(self, now_s: float) -> Vec3:
        """As a level vehicle would turn it into its frame."""
        forward, right, down = self.faults.accel_error_frd_m_s2
        noise = self.faults.accel_noise_m_s2
        if noise > 0.0:
            sample = int(now_s * IMU_HZ)
            forward += noise * self._noise(sample, 0, IMU_NOISE)
            right += noise * self._noise(sample, 1, IMU_NOISE)
            down += noise * self._noise(sample, 2, IMU_NOISE)
        cosine, sine = cos(self._motion.yaw_rad), sin(self._motion.yaw_rad)
        return forward * cosine - right * sine, forward * sine + right * cosine, down

    def gyro_yaw_error_rad_s(self, now_s: float) -> float:
        noise = self.faults.gyro_noise_rad_s
        return self.faults.gyro_yaw_error_rad_s + noise * self._noise(int(now_s * IMU_HZ), 3, IMU_NOISE)

    def field_frd_mgauss(self, now_s: float) -> Vec3:
        """What a level compass measures."""
        if self.faults.compass_dead:
            return 0.0, 0.0, 0.0
        faults = self.faults
        height_m = max(0.0, -self._motion.down_m)
        left = 1.0 / (1.0 + height_m / faults.anomaly_height_m) ** 3
        north = EARTH_FIELD_MGAUSS[0] + left * faults.anomaly_ne_mgauss[0]
        east = EARTH_FIELD_MGAUSS[1] + left * faults.anomaly_ne_mgauss[1]
        cosine, sine = cos(self._motion.yaw_rad), sin(self._motion.yaw_rad)
        sample, noise = int(now_s * COMPASS_HZ), faults.compass_noise_mgauss
        return (
            north * cosine + east * sine + faults.compass_offset_fr_mgauss[0]
            + noise * self._noise(sample, 0, COMPASS_NOISE),
            east * cosine - north * sine + faults.compass_offset_fr_mgauss[1]
            + noise * self._noise(sample, 1, COMPASS_NOISE),
            EARTH_FIELD_MGAUSS[2],
        )  # fmt: skip

    def compass_error_rad(self, now_s: float) -> float:
        forward, right, _ = self.field_frd_mgauss(now_s)
        return wrap_pi(atan2(-right, forward) - self._motion.yaw_rad)

    def _noise(self, sample: int, axis: int, purpose: int) -> float:
        """Even in -1 to 1."""
        return 2.0 * draw(self._seed, sample, 4 * self._who + axis, purpose) - 1.0
