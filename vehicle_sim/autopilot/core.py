"""What every flavor of autopilot is without its wire: a machine, what it believes of it, its plans, and time going by.

What it has to say is collected in `texts`; `announce` is set when a heartbeat should go out at once. The flavors are
`copter`, an ArduCopter, and `px4.commander`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from enum import IntEnum
from math import ceil

from comms.frames import GeoPoint, enu_from_geo, geo_from_enu, swap_enu_ned
from vehicle_sim.autopilot.body import Body
from vehicle_sim.autopilot.boot import Boot, Script
from vehicle_sim.autopilot.estimate import Estimate
from vehicle_sim.autopilot.guidance import Guidance
from vehicle_sim.autopilot.parameters import LIMIT_NAMES, Parameters
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.plans.keeper import Keeper
from vehicle_sim.autopilot.plans.rules import PlanRules
from vehicle_sim.autopilot.severity import INFO
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.autopilot.sticks import NO_RADIO, TIMEOUT_S, Sticks
from vehicle_sim.vehicle import VehicleConfig

LANDED_AFTER_S = 1.3  # on the ground until the land detector believes it (recorded)
FURTHEST_M = 1e6


class Autopilot(ABC):
    """One vehicle's autopilot with its airframe, battery, boot sequence and parameters. Local frame: NED from home.

    Attributes:
        flying: the autopilot's belief: from the spool-up until the land detector.
        restarted: a reboot: every link forgets what it was asked for.
        home_news: home or origin was just set: the link sends both unasked.
    """

    mode: IntEnum
    guidance: Guidance

    def __init__(
        self,
        *,
        config: VehicleConfig,
        system_id: int,
        home: GeoPoint,
        heading_rad: float,
        seed: int,
        started_at_s: float,
        parameters: Parameters,
        script: Script,
        rules: PlanRules,
    ) -> None:
        self.origin = home
        self.system_id = system_id
        self.started_at_s = self.now_s = started_at_s
        self.parameters = parameters
        self.body = Body(
            config=config, parameters=self.parameters, heading_rad=heading_rad, latitude_deg=home.latitude_deg,
            seed=seed, who=system_id, now_s=started_at_s,
        )  # fmt: skip
        self.airframe, self.sensors, self.charge = self.body.airframe, self.body.sensors, self.body.charge
        self.estimate = Estimate(
            airframe=self.airframe, sensors=self.sensors, parameters=self.parameters, now_s=started_at_s
        )
        self.boot = Boot(script, boot_s=config.boot_s, field_elevation_m=home.altitude_m)
        self.texts: list[tuple[int, str]] = []
        self.plans = Keeper(rules, parameters=self.parameters, say=self.say, home=lambda: self.home)
        self.mission = self.plans.mission
        self.steering = Steering(
            airframe=self.estimate, parameters=self.parameters, origin=home, rallies=self.plans.rallies, say=self.say
        )
        self.armed = self.flying = False
        self.announce = self.restarted = self.home_news = False
        self._idle_since_s = started_at_s
        self._sticks_until_s = started_at_s

    def fly_by(self, guidance: Guidance) -> None:
        """What turns its mode into a demand; part of powering on."""
        self.guidance = guidance
        self.parameters.on_change(LIMIT_NAMES, guidance.retune)

    @property
    def home(self) -> GeoPoint:
        """Where a return goes."""
        return geo_from_enu(self.origin, swap_enu_ned(self.steering.home_ned_m))

    @property
    @abstractmethod
    def has_position(self) -> bool:
        """Whether it knows its place, and trusts that."""

    @abstractmethod
    def set_mode(self, number: int) -> bool:
        """Change the flight mode; a refusal may say why. Returns whether it was done."""

    @abstractmethod
    def disarm(self, *, forced: bool) -> bool:
        """Stop the motors, `forced` in the air too. Returns whether they stand."""

    @abstractmethod
    def reboot(self) -> bool:
        """Start over where it is, with the parameters and plans it has. Not while armed."""

    @abstractmethod
    def fly_item(self, item: Item, there: bool) -> bool:
        """A mission item as an order: fly to its place, or (not `there`) to its height. Whether it does."""

    @abstractmethod
    def watch(self) -> None:
        """Look at what has happened until now, and act on it."""

    @abstractmethod
    def touch_down(self, speed_m_s: float) -> None:
        """It hit the ground, this fast."""

    def set_home(self, place: GeoPoint | None) -> bool:
        """Home is at `place` from now on, or (None) here. False without an origin, or for a place far beyond reach."""
        steering = self.steering
        ned_m = steering.place_ned_m if place is None else swap_enu_ned(enu_from_geo(self.origin, place))
        if not self.boot.stage.origin or not all(abs(x) <= FURTHEST_M for x in ned_m):  # NaN compares false
            return False
        steering.home_ned_m = ned_m
        self.home_news = True
        return True

    def take_sticks(self, sticks: Sticks) -> None:
        """A pilot's hands; without news of them for TIMEOUT_S the sticks are let go."""
        self.steering.sticks = sticks
        self.steering.throttle_up |= sticks.throttle > 0.0
        self._sticks_until_s = self.now_s + TIMEOUT_S

    def advance(self, now_s: float) -> None:
        """Live until `now_s`: boot, fly in equal steps no longer than STEP_S, then look at what has happened."""
        span_s = now_s - self.now_s
        if span_s <= 0.0:
            return
        self._boot(now_s)
        if self.now_s > self._sticks_until_s:
            self.steering.sticks = NO_RADIO
        steps = max(1, ceil(span_s / self.body.step_s - 1e-6))
        dt_s = span_s / steps
        began_s = self.now_s
        for step in range(steps):
            self.now_s = began_s + step * dt_s
            self._fly(dt_s)
        self.now_s = now_s
        self.body.drain(span_s, armed=self.armed, now_s=now_s)
        self.watch()

    def say(self, severity: int, text: str) -> None:
        self.texts.append((severity, text))

    def _boot(self, now_s: float) -> None:
        had_origin = self.boot.stage.origin
        for text in self.boot.advance(now_s - self.started_at_s):
            self.say(INFO, text)
        if self.boot.stage.origin and not had_origin:
            self.home_news = True

    def _fly(self, dt_s: float) -> None:
        """One step: what guidance wants, as the estimate turns it, moves the body; then the estimate follows."""
        demand = self.guidance.demand(self.now_s) if self.armed else None
        if self.guidance.spooled(self.now_s):
            self.flying = True
        if not self.airframe.on_ground or demand is not None:
            self.body.move(dt_s, self.estimate.steered(demand) if demand is not None else None, self.now_s)
            if self.airframe.impact_m_s is not None:
                self._idle_since_s = self.now_s + dt_s
                self.touch_down(self.airframe.impact_m_s)
        elif self.estimate.exact:
            return
        self.estimate.advance(dt_s, self.now_s + dt_s)
