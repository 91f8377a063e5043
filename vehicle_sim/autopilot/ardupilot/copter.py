"""An ArduCopter: its modes, how it arms and disarms, and what it says."""

from __future__ import annotations

from comms.frames import GeoPoint
from vehicle_sim.autopilot.ardupilot.boot import ARDUCOPTER
from vehicle_sim.autopilot.ardupilot.guidance import CopterGuidance
from vehicle_sim.autopilot.ardupilot.modes import MODES, Mode
from vehicle_sim.autopilot.ardupilot.parameters import ARDUCOPTER_CATALOG, arducopter_values
from vehicle_sim.autopilot.ardupilot.safety.arming import Reminder, complaints
from vehicle_sim.autopilot.ardupilot.safety.failsafes import Failsafes
from vehicle_sim.autopilot.ardupilot.safety.fence import Fence, named
from vehicle_sim.autopilot.ardupilot.watched import Watched
from vehicle_sim.autopilot.core import FURTHEST_M, LANDED_AFTER_S
from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.plans.rules import ARDUCOPTER_PLANS
from vehicle_sim.autopilot.setpoints import Setpoint
from vehicle_sim.autopilot.severity import CRITICAL, INFO, WARNING
from vehicle_sim.autopilot.steering import TIME_SLACK_S
from vehicle_sim.vehicle import VehicleConfig

DISARMED_AFTER_S = 2.1  # on the ground until LAND and RTL disarm (recorded)
YAW_ALIGNMENT_M = 2.5
HIGHEST_TAKEOFF_M = 10_000.0
ARMS_IN_AUTO = 1  # a bit of AUTO_OPTIONS


class Copter(Watched):
    """One ArduCopter.

    Attributes:
        home_locked: a ground station said where home is; otherwise it is where the vehicle was armed last.
    """

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
        super().__init__(
            config=config,
            system_id=system_id,
            home=home,
            heading_rad=heading_rad,
            seed=seed,
            started_at_s=started_at_s,
            parameters=Parameters(ARDUCOPTER_CATALOG, arducopter_values(config, system_id)),
            script=ARDUCOPTER,
            rules=ARDUCOPTER_PLANS,
        )
        self.fence = Fence(self.plans.fences)
        self.fly_by(CopterGuidance(steering=self.steering, mission=self.mission))
        self.mode = Mode.STABILIZE
        self.failsafes = Failsafes()
        self._reminder = Reminder(started_at_s=started_at_s)
        self._yaw_aligned = False
        self.home_locked = False

    @property
    def has_position(self) -> bool:
        return self.boot.stage.position and self.estimate.has_position and not self.failsafes.ekf.active

    @property
    def outside(self) -> str:
        return named(self.fence.beyond_m(self))

    # What a ground station asks for. Each returns whether it was done.

    def set_mode(self, number: int) -> bool:
        """Change the flight mode; a refusal says why."""
        if number not in Mode.__members__.values():
            self.say(WARNING, f"No such mode {number}")
            return False
        mode = Mode(number)
        if mode is self.mode:
            return True
        if self.armed and MODES[mode].needs_position and not self.has_position:
            self.say(WARNING, f"Mode change to {mode.name} failed: requires position")
            return False
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
        if self.has_position and not self.home_locked:
            self.set_home(None)
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
        """Take off to `altitude_m` above home. Only armed, on the ground, in a mode for it, and up to a sane one."""
        able = MODES[self.mode].takes_off and (MODES[self.mode].needs_position or not navigates)
        ready = self.armed and able and not self.flying and not self.guidance.taking_off
        if not ready or not self.steering.height_m < altitude_m <= HIGHEST_TAKEOFF_M:  # NaN compares false
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

    def reboot(self) -> bool:
        """Start over where it stands, with the parameters and plans it has. Not while armed.

        Its local frame stays where it was at power-on; a real one would begin a new one here.
        """
        if self.armed:
            return False
        self.started_at_s = self.now_s
        self.boot.restart()
        self.fence, self.failsafes = Fence(self.plans.fences), Failsafes()
        self._reminder = Reminder(started_at_s=self.now_s)
        self._yaw_aligned = self.home_locked = False
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
        return self.follow(Setpoint(position_ned_m=goal if there else (north_m, east_m, goal[2])))

    def follow(self, setpoint: Setpoint) -> bool:
        """Fly a setpoint of GUIDED, unless it leads beyond the fence."""
        allowed = setpoint.position_ned_m is None or self.fence.allows(self, setpoint.position_ned_m)
        if allowed:
            self.guidance.follow(setpoint, self.now_s)
        return allowed

    def hear_gcs(self) -> None:
        """A heartbeat of the ground station that the failsafe counts."""
        self.failsafes.gcs.hear(self.now_s)

    # Time.

    def watch(self) -> None:
        if self.flying:
            self.guidance.drop_crumb()
        self._watch_ground()
        self.failsafes.watch(self)
        self.fence.watch(self)
        for text in self._reminder.due(self):
            self.say(CRITICAL, text)

    def touch_down(self, speed_m_s: float) -> None:
        self.say(INFO, f"SIM Hit ground at {speed_m_s:.6g} m/s")

    @property
    def _armable(self) -> bool:
        may_in_auto = int(self.parameters["AUTO_OPTIONS"]) & ARMS_IN_AUTO
        return MODES[self.mode].armable or (self.mode is Mode.AUTO and bool(may_in_auto))

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
