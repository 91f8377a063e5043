"""The machine under the autopilot: airframe, battery and sensors in the air around them. SIM_* parameters break it."""

from __future__ import annotations

from vehicle_sim.autopilot.faults import SENSOR_NAMES, battery, motor_share, sensor_faults, wind
from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.battery import IDLE_SHARE, Charge
from vehicle_sim.flight import Airframe, Demand, Multirotor
from vehicle_sim.sensors import Sensors
from vehicle_sim.vehicle import VehicleConfig
from vehicle_sim.wind import LocalWind

STEP_S = {"simulated": 0.05, "ideal": 1.0}  # the longest step of physics
HOVER_THROTTLE = 0.39  # MOT_THST_HOVER: a motor with less than this share of its thrust cannot carry its corner


class Body:
    """One vehicle's machine.

    Attributes:
        step_s: the longest step it may be advanced by.
    """

    def __init__(
        self, *, config: VehicleConfig, parameters: Parameters, heading_rad: float, latitude_deg: float, seed: int,
        who: int, now_s: float,
    ) -> None:  # fmt: skip
        self.step_s = STEP_S[config.kind]
        self.wind = LocalWind(config.wind, seed=seed, who=who)
        self.airframe: Airframe
        if config.kind == "ideal":
            self.airframe = Airframe(limits=config.limits, yaw_rad=heading_rad)
        else:
            self.airframe = Multirotor(
                limits=config.limits, yaw_rad=heading_rad, trimmed_ne_m_s=self.wind.steady_ne_m_s
            )
        self.charge = Charge(config.battery)
        self.sensors = Sensors(motion=self.airframe, seed=seed, who=who)
        self._parameters = parameters
        self._latitude_deg = latitude_deg
        self._now_s = now_s
        parameters.on_change(SENSOR_NAMES, self._disturb_sensors)
        parameters.on_change(("SIM_WIND_",), lambda: self.wind.change(wind(parameters)))
        parameters.on_change(("SIM_BATT_",), lambda: self.charge.supply(**battery(parameters)))
        parameters.on_change(("SIM_ENGINE_",), self._break_motor)

    def move(self, dt_s: float, demand: Demand | None, now_s: float) -> None:
        """Move for `dt_s` from `now_s` on; an empty battery turns no motor."""
        self.airframe.step(dt_s, None if self.charge.empty else demand, self.wind.at(now_s))

    def drain(self, span_s: float, *, armed: bool, now_s: float) -> None:
        """Draw what the last `span_s` took."""
        self._now_s = now_s
        effort = 0.0
        if armed:
            effort = IDLE_SHARE if self.airframe.on_ground else self.airframe.effort
        self.charge.drain(effort=effort, dt_s=span_s)

    def _disturb_sensors(self) -> None:
        self.sensors.set_faults(sensor_faults(self._parameters, self._latitude_deg), self._now_s)

    def _break_motor(self) -> None:
        self.airframe.uncontrolled = motor_share(self._parameters) < HOVER_THROTTLE
