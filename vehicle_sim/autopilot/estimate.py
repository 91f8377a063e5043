"""Where the autopilot believes the vehicle is: what telemetry reports and guidance flies by.

The estimate is the truth plus an error, and the error follows the errors of the sensors as those of an EKF3 do: GPS
draws it, unless a reading is so far off that it is rejected; without GPS the accelerometers let it drift. While the
sensors tell the truth and no error is left, the estimate is the truth to the last bit.
"""

from __future__ import annotations

from math import cos, hypot, sin
from typing import NamedTuple

from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.flight import Airframe, Demand, FlightLimits, Motion, wrap_pi
from vehicle_sim.sensors import NONE, Sensors

LOST_AFTER_S = 7.0  # without an accepted fix: no position any more (recorded)
RESET_AFTER_S = 10.0  # of rejected fixes: the next one is believed (EKF3)
GLITCH_AFTER_S, TRUST_AFTER_S = 1.0, 10.0  # of bad, and of good fixes: EKF3's hysteresis
POSITION_GAIN_1_S, VELOCITY_GAIN_1_S, ACROSS_GAIN_1_S2 = 1.0, 1.0, 0.3
HEIGHT_GAIN_1_S, HEADING_GAIN_1_S = 1.0, 0.5
SETTLED = 1e-4  # errors below are none


class Variances(NamedTuple):
    """EKF_STATUS_REPORT: how far off each kind of reading is, over what would be rejected."""

    velocity: float = 0.005  # these are what a recorded vehicle reports when all is well
    position: float = 0.005
    height: float = 0.001
    compass: float = 0.008


CALM = Variances()


class Estimate(Motion):
    """One vehicle's own idea of its motion.

    Attributes:
        has_position: whether it still knows its place. glitching: whether GPS contradicts it.
    """

    def __init__(self, *, airframe: Airframe, sensors: Sensors, parameters: Parameters, now_s: float) -> None:
        super().__init__(yaw_rad=airframe.yaw_rad)
        self.has_position = True
        self.glitching = False
        self.variances = CALM
        self._airframe = airframe
        self._sensors = sensors
        self._parameters = parameters
        self._exact = True
        self._error_ned_m = [0.0, 0.0, 0.0]
        self._error_ned_m_s = [0.0, 0.0, 0.0]
        self._heading_error_rad = 0.0
        self._accepted_at_s = self._good_at_s = self._bad_at_s = now_s

    @property
    def exact(self) -> bool:
        """Whether it is the truth, to the last bit."""
        return self._exact and self._sensors.faults is NONE

    @property
    def attitude_rad(self) -> tuple[float, float]:
        """(roll, pitch): the horizon is always known."""
        return self._airframe.attitude_rad

    @property
    def limits(self) -> FlightLimits:
        return self._airframe.limits

    def set_limits(self, limits: FlightLimits) -> None:
        self._airframe.set_limits(limits)

    def advance(self, dt_s: float, now_s: float) -> None:
        """The airframe has moved by a step that ends at `now_s`."""
        frame = self._airframe
        if not self._exact or self._sensors.faults is not NONE:
            self._estimate(dt_s, now_s)
        if self._exact:
            self.north_m, self.east_m, self.down_m = frame.north_m, frame.east_m, frame.down_m
            self.north_m_s, self.east_m_s, self.down_m_s = frame.north_m_s, frame.east_m_s, frame.down_m_s
            self.yaw_rad, self.yaw_rate_rad_s, self.on_ground = frame.yaw_rad, frame.yaw_rate_rad_s, frame.on_ground
            return
        (north, east, down), (north_m_s, east_m_s, down_m_s) = self._error_ned_m, self._error_ned_m_s
        self.north_m, self.east_m, self.down_m = frame.north_m + north, frame.east_m + east, frame.down_m + down
        self.north_m_s, self.east_m_s = frame.north_m_s + north_m_s, frame.east_m_s + east_m_s
        self.down_m_s = frame.down_m_s + down_m_s
        self.yaw_rad = wrap_pi(frame.yaw_rad + self._heading_error_rad)
        self.yaw_rate_rad_s = frame.yaw_rate_rad_s
        self.on_ground = frame.on_ground

    def steered(self, demand: Demand) -> Demand:
        """What the airframe is asked for when its autopilot believes this: what seems to be missing, where it seems.

        Without a position there is nothing to hold: it stays level.
        """
        if self.exact:
            return demand
        frame, turned_rad = self._airframe, self._heading_error_rad
        demand = demand._replace(down_m_s=frame.down_m_s + demand.down_m_s - self.down_m_s)
        if not self.has_position:
            return demand._replace(level=True)
        north, east = demand.north_m_s - self.north_m_s, demand.east_m_s - self.east_m_s
        return demand._replace(
            north_m_s=frame.north_m_s + cos(turned_rad) * north + sin(turned_rad) * east,
            east_m_s=frame.east_m_s + cos(turned_rad) * east - sin(turned_rad) * north,
        )

    def _estimate(self, dt_s: float, now_s: float) -> None:
        """Let the errors grow and be corrected for one step."""
        if self._exact:
            self._exact = False
            self._accepted_at_s = self._good_at_s = now_s
            self._bad_at_s = now_s - TRUST_AFTER_S
        position, velocity = self._fuse_gps(dt_s, now_s)
        height = self._fuse_baro(dt_s, now_s)
        compass = self._fuse_compass(dt_s, now_s)
        self.variances = Variances(
            max(CALM.velocity, velocity), max(CALM.position, position), max(CALM.height, height),
            max(CALM.compass, compass),
        )  # fmt: skip
        self._judge(max(position, velocity), now_s)
        if self._sensors.faults is NONE and self.has_position and not self.glitching:
            self._settle()

    def _settle(self) -> None:
        """Without faults the last small error vanishes, and with it all this arithmetic."""
        errors = (*self._error_ned_m, *self._error_ned_m_s, self._heading_error_rad)
        if max(map(abs, errors)) < SETTLED:
            self._error_ned_m, self._error_ned_m_s, self._heading_error_rad = [0.0] * 3, [0.0] * 3, 0.0
            self.variances = CALM
            self._exact = True

    def _fuse_gps(self, dt_s: float, now_s: float) -> tuple[float, float]:
        """How far off the position and the velocity are, over what would be rejected."""
        place, speed = self._error_ned_m, self._error_ned_m_s
        if not self._sensors.has_fix:
            self.has_position = self.has_position and now_s - self._accepted_at_s < LOST_AFTER_S
            if self.has_position:
                self._drift(dt_s, now_s)
            return 0.0, 0.0
        gps, gps_m_s = self._sensors.gps_error_ned_m(now_s), self._sensors.faults.gps_velocity_error_ne_m_s
        off_m = (gps[0] - place[0], gps[1] - place[1])
        off_m_s = (gps_m_s[0] - speed[0], gps_m_s[1] - speed[1])
        position = hypot(*off_m) / self._gate("EK3_POS_I_GATE", "EK3_POSNE_M_NSE")
        velocity = hypot(*off_m_s) / self._gate("EK3_VEL_I_GATE", "EK3_VELNE_M_NSE")
        if not self.has_position or now_s - self._accepted_at_s >= RESET_AFTER_S:
            place[:2], speed[:2] = gps[:2], gps_m_s
            self.has_position = True
            self._accepted_at_s = now_s
            return position, velocity
        if position < 1.0:
            self._accepted_at_s = now_s
        for axis in (0, 1):
            if velocity < 1.0:
                speed[axis] += VELOCITY_GAIN_1_S * off_m_s[axis] * dt_s
            if position < 1.0:
                speed[axis] += ACROSS_GAIN_1_S2 * off_m[axis] * dt_s
                place[axis] += POSITION_GAIN_1_S * off_m[axis] * dt_s
            place[axis] += speed[axis] * dt_s
        return position, velocity

    def _drift(self, dt_s: float, now_s: float) -> None:
        bias = self._sensors.accel_error_ned_m_s2(now_s)
        for axis in (0, 1):
            self._error_ned_m_s[axis] += bias[axis] * dt_s
            self._error_ned_m[axis] += self._error_ned_m_s[axis] * dt_s

    def _fuse_baro(self, dt_s: float, now_s: float) -> float:
        off_m = -self._sensors.baro_error_m(now_s) - self._error_ned_m[2]
        self._error_ned_m_s[2] = HEIGHT_GAIN_1_S * off_m
        self._error_ned_m[2] += self._error_ned_m_s[2] * dt_s
        return abs(off_m) / self._gate("EK3_HGT_I_GATE", "EK3_ALT_M_NSE")

    def _fuse_compass(self, dt_s: float, now_s: float) -> float:
        sensors = self._sensors
        rate_rad_s, off_rad = sensors.faults.gyro_yaw_error_rad_s, 0.0
        if not sensors.faults.compass_dead:
            off_rad = wrap_pi(sensors.compass_error_rad(now_s) - self._heading_error_rad)
            rate_rad_s += HEADING_GAIN_1_S * off_rad
        self._heading_error_rad = wrap_pi(self._heading_error_rad + rate_rad_s * dt_s)
        return abs(off_rad) / self._gate("EK3_YAW_I_GATE", "EK3_YAW_M_NSE")

    def _judge(self, worst: float, now_s: float) -> None:
        """A glitch is bad fixes for a while, and is over after good ones for a while."""
        if worst < 1.0:
            self._good_at_s = now_s
            if self.glitching and now_s - self._bad_at_s >= TRUST_AFTER_S:
                self.glitching = False
        else:
            self._bad_at_s = now_s
            if now_s - self._good_at_s >= GLITCH_AFTER_S:
                self.glitching = True

    def _gate(self, sigmas: str, noise: str) -> float:
        return max(0.01, self._parameters[sigmas] / 100.0 * self._parameters[noise])
