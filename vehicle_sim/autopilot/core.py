"""The autopilot itself, without its wire: mode, arming, and time going by.

What it has to say is collected in `texts`; `announce` is set when a heartbeat should go out at once.
"""

from __future__ import annotations

from math import ceil

from comms.frames import GeoPoint, enu_from_geo, geo_from_enu, swap_enu_ned
from vehicle_sim.autopilot.arming import Reminder, complaints
from vehicle_sim.autopilot.body import Body
from vehicle_sim.autopilot.boot import Boot
from vehicle_sim.autopilot.estimate import Estimate
from vehicle_sim.autopilot.failsafes import Failsafes
from vehicle_sim.autopilot.fence import Fence
from vehicle_sim.autopilot.guidance import Guidance
from vehicle_sim.autopilot.modes import MODES, Mode
from vehicle_sim.autopilot.parameters import LIMIT_NAMES, Parameters
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.plans.keeper import Keeper
from vehicle_sim.autopilot.setpoints import Setpoint
from vehicle_sim.autopilot.severity import CRITICAL, INFO, WARNING
from vehicle_sim.autopilot.steering import TIME_SLACK_S, Steering
from vehicle_sim.autopilot.sticks import NO_RADIO, TIMEOUT_S, Sticks
from vehicle_sim.vehicle import VehicleConfig

LANDED_AFTER_S = 1.3  # on the ground until the land detector believes it (recorded)
DISARMED_AFTER_S = 2.1  # on the ground until LAND and RTL disarm (recorded)
YAW_ALIGNMENT_M = 2.5
HIGHEST_TAKEOFF_M = 10_000.0
FURTHEST_M = 1e6
ARMS_IN_AUTO = 1  # a bit of AUTO_OPTIONS


class Autopilot:
    """One vehicle's autopilot with its airframe, battery, boot sequence and parameters. Local frame: NED from home."""

    def __init__(
        self,
        *,
        config: VehicleConfig,
        system_id: int,
        home: GeoPoint,
        heading_rad: float,
        seed: int,
        started_at_s: float,
    ) -> None:
        self.origin = home
        self.system_id = system_id
        self.started_at_s = self.now_s = started_at_s
        self.parameters = Parameters(
            system_id=system_id, limits=config.limits, battery=config.battery, wind=config.wind
        )
        self.body = Body(
            config=config, parameters=self.parameters, heading_rad=heading_rad, latitude_deg=home.latitude_deg,
            seed=seed, who=system_id, now_s=started_at_s,
        )  # fmt: skip
        self.airframe, self.sensors, self.charge = self.body.airframe, self.body.sensors, self.body.charge
        self.estimate = Estimate(
            airframe=self.airframe, sensors=self.sensors, parameters=self.parameters, now_s=started_at_s
        )
        self.boot = Boot(boot_s=config.boot_s, field_elevation_m=home.altitude_m)
        self.texts: list[tuple[int, str]] = []
        self.plans = Keeper(parameters=self.parameters, say=self.say, home=lambda: self.home)
        self.mission = self.plans.mission
        self.fence = Fence(self.plans.fences)
        steering = Steering(
            airframe=self.estimate, parameters=self.parameters, origin=home, rallies=self.plans.rallies, say=self.say
        )
        self.guidance = Guidance(steering=steering, mission=self.mission)
        self.parameters.on_change(LIMIT_NAMES, self.guidance.retune)
        self.mode = Mode.STABILIZE
        self.armed = False
        self.flying = False  # the autopilot's belief: from the spool-up until the land detector
        self.failsafes = Failsafes()
        self.announce = False
        self.restarted = False  # a reboot: every link forgets what it was asked for
        self.home_news = False  # home or origin was just set: the link sends both unasked
        self._idle_since_s = started_at_s
        self._reminder = Reminder(started_at_s=started_at_s)
        self._yaw_aligned = False
        self._sticks_until_s = started_at_s

    @property
    def has_position(self) -> bool:
        """Whether it knows its place, and trusts that."""
        return self.boot.stage.position and self.estimate.has_position and not self.failsafes.ekf.active

    @property
    def home(self) -> GeoPoint:
        """Where RTL goes."""
        return geo_from_enu(self.origin, swap_enu_ned(self.guidance.steering.home_ned_m))

    # What a ground station asks for. Each returns whether it was done.

    def set_mode(self, number: int) -> bool:
        """Change the flight mode; a refusal says why."""
        if number not in Mode.__members__.values():
            self.say(WARNING, f"No such mode {number}")
            return False
        mode = Mode(number)
        if self.armed and MODES[mode].needs_position and not self.has_position:
            self.say(WARNING, f"Mode change to {mode.name} failed: requires position")
            return False
        if mode is self.mode:
            return True
        if not self.guidance.can_enter(mode, armed=self.armed, flying=self.flying):
            self.say(WARNING, f"Mode change to {mode.name} failed: init failed")
            return False
        self.mode = mode
        self.announce = True
        self.guidance.enter(mode, self.now_s)
        return True

    def arm(self, *, forced: bool) -> bool:
        if self.armed:
            return True
        reasons = [] if forced else complaints(self)
        if not forced and not self._armable:
            reasons.append("Mode not armable")
        for reason in reasons:
            self.say(CRITICAL, f"Arm: {reason}")
        if reasons:
            return False
        self.armed = self.announce = True
        self.home_news = self.boot.stage.origin
        self._idle_since_s = self.now_s
        self.guidance.enter(self.mode, self.now_s)
        if self.boot.stage.position:
            self.guidance.breadcrumbs.begin(self.guidance.steering.place_ned_m)
        self.say(INFO, "Arming motors")
        return True

    def disarm(self, *, forced: bool) -> bool:
        if not self.armed:
            return True
        if self.flying and not forced:
            return False
        self.armed = self.flying = self.guidance.steering.throttle_up = False
        self.mission.reset()
        self.announce = True
        self.guidance.rest(self.now_s)
        self._reminder.restart(self.now_s)
        self.say(INFO, "Disarming motors")
        return True

    def take_off(self, altitude_m: float, *, navigates: bool = True) -> bool:
        """Take off to `altitude_m` above home. Only armed, on the ground, in a mode for it, and to a sane altitude."""
        able = MODES[self.mode].takes_off and (MODES[self.mode].needs_position or not navigates)
        ready = self.armed and able and not self.flying and not self.guidance.taking_off
        if not ready or not 0.0 < altitude_m <= HIGHEST_TAKEOFF_M:  # NaN compares false
            return False
        self.guidance.take_off(altitude_m, self.now_s)
        return True

    def start_mission(self) -> bool:
        """MISSION_START: AUTO, and the throttle up."""
        if not self.set_mode(Mode.AUTO):
            return False
        self.guidance.steering.throttle_up = True
        if self.mission.complete:
            self.mission.begin(restarts=True)
        return True

    def set_home(self, place: GeoPoint | None) -> bool:
        """Home is at `place` from now on, or (None) here. False without an origin, or for a place far beyond reach."""
        steering = self.guidance.steering
        ned_m = steering.place_ned_m if place is None else swap_enu_ned(enu_from_geo(self.origin, place))
        if not self.boot.stage.origin or not all(abs(x) <= FURTHEST_M for x in ned_m):  # NaN compares false
            return False
        steering.home_ned_m = ned_m
        self.home_news = True
        return True

    def reboot(self) -> bool:
        """Start over where it stands, with the parameters and plans it has. Not while armed.

        Its local frame stays where it was at power-on; a real one would begin a new one here.
        """
        if self.armed:
            return False
        self.started_at_s = self.now_s
        self.boot.restart()
        self.failsafes, self._reminder = Failsafes(), Reminder(started_at_s=self.now_s)
        self._yaw_aligned = False
        self.mode = Mode.STABILIZE
        self.mission.reset()
        self.mission.complete = False
        self.guidance.breadcrumbs.forget()
        self.guidance.steering.home_ned_m = self.guidance.steering.place_ned_m
        self.guidance.enter(self.mode, self.now_s)
        self.announce = self.restarted = True
        return True

    def fly_item(self, item: Item, there: bool) -> bool:
        """The old way to steer GUIDED: a mission item as an order, to its place or (not `there`) to its height."""
        steering = self.guidance.steering
        goal = steering.ned_from_item(item)
        if self.mode is not Mode.GUIDED or not all(abs(x) <= FURTHEST_M for x in goal):
            return False
        north_m, east_m, _ = steering.place_ned_m
        self.guidance.follow(Setpoint(position_ned_m=goal if there else (north_m, east_m, goal[2])), self.now_s)
        return True

    def hear_gcs(self) -> None:
        """A heartbeat of the ground station that the failsafe counts."""
        self.failsafes.gcs.hear(self.now_s)

    def take_sticks(self, sticks: Sticks) -> None:
        """A pilot's hands; without news of them for TIMEOUT_S the sticks are let go."""
        self.guidance.steering.sticks = sticks
        self.guidance.steering.throttle_up |= sticks.throttle > 0.0
        self._sticks_until_s = self.now_s + TIMEOUT_S

    # Time.

    def advance(self, now_s: float) -> None:
        """Live until `now_s`: boot, fly in equal steps no longer than STEP_S, then look at what has happened."""
        span_s = now_s - self.now_s
        if span_s <= 0.0:
            return
        self._boot(now_s)
        if self.now_s > self._sticks_until_s:
            self.guidance.steering.sticks = NO_RADIO
        steps = max(1, ceil(span_s / self.body.step_s - 1e-6))
        dt_s = span_s / steps
        began_s = self.now_s
        for step in range(steps):
            self.now_s = began_s + step * dt_s
            self._fly(dt_s)
        self.now_s = now_s
        self.body.drain(span_s, armed=self.armed, now_s=now_s)
        if self.flying:
            self.guidance.drop_crumb()
        self._watch_ground()
        self.failsafes.watch(self)
        self.fence.watch(self)
        for text in self._reminder.due(self):
            self.say(CRITICAL, text)

    def say(self, severity: int, text: str) -> None:
        self.texts.append((severity, text))

    @property
    def _armable(self) -> bool:
        may_in_auto = int(self.parameters["AUTO_OPTIONS"]) & ARMS_IN_AUTO
        return MODES[self.mode].armable or (self.mode is Mode.AUTO and bool(may_in_auto))

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
                self.say(INFO, f"SIM Hit ground at {self.airframe.impact_m_s:.6g} m/s")
        elif self.estimate.exact:
            return
        self.estimate.advance(dt_s, self.now_s + dt_s)

    def _watch_ground(self) -> None:
        """Notice takeoff and landing, and disarm what has been on the ground for long enough."""
        if not self.airframe.on_ground:
            if not self._yaw_aligned and -self.airframe.down_m > YAW_ALIGNMENT_M:
                self._yaw_aligned = True
                self.say(INFO, "EKF3 IMU1 MAG0 in-flight yaw alignment complete")
                self.say(INFO, "EKF3 IMU0 MAG0 in-flight yaw alignment complete")
            return
        if not self.armed or self.guidance.taking_off or self.airframe.tumbling:
            return
        idle_s = self.now_s - self._idle_since_s + TIME_SLACK_S
        landing = self.guidance.lands
        if self.flying and idle_s >= LANDED_AFTER_S:
            self.flying = False
        delay_s = DISARMED_AFTER_S if landing else self.parameters["DISARM_DELAY"]
        if (landing or delay_s > 0.0) and idle_s >= delay_s and not self.flying:
            self.disarm(forced=False)
