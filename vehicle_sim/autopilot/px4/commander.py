"""A PX4: the mode somebody wants and the mode it flies, how it arms and disarms, and what it says."""

from __future__ import annotations

from comms.frames import GeoPoint, Vec3
from vehicle_sim.autopilot.core import LANDED_AFTER_S
from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.px4.battery import Level
from vehicle_sim.autopilot.px4.boot import PX4_BOOT
from vehicle_sim.autopilot.px4.checks import can_run, complaints
from vehicle_sim.autopilot.px4.failsafes import Failsafes
from vehicle_sim.autopilot.px4.geofence import Geofence
from vehicle_sim.autopilot.px4.guidance import Px4Guidance
from vehicle_sim.autopilot.px4.modes import MODES, Mode
from vehicle_sim.autopilot.px4.navigation.hold import Hold
from vehicle_sim.autopilot.px4.navigation.takeoff import Lift
from vehicle_sim.autopilot.px4.parameters import CATALOG, px4_values
from vehicle_sim.autopilot.px4.plans import PX4_PLANS
from vehicle_sim.autopilot.px4.setpoints import Trajectory
from vehicle_sim.autopilot.px4.watched import Watched
from vehicle_sim.autopilot.setpoints import Attitude
from vehicle_sim.autopilot.severity import CRITICAL, INFO
from vehicle_sim.autopilot.steering import TIME_SLACK_S
from vehicle_sim.autopilot.sticks import Sticks
from vehicle_sim.vehicle import VehicleConfig

EXTERNAL, LANDING, PREFLIGHT, MISSION_START, FAILSAFE = (
    "external command", "landing", "auto preflight disarming", "mission start", "failsafe",
)  # fmt: skip
NEVER_S = -1e9


class Commander(Watched):
    """One PX4."""

    guidance: Px4Guidance

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
            parameters=Parameters(CATALOG, px4_values(config, system_id)),
            script=PX4_BOOT,
            rules=PX4_PLANS,
        )
        self.geofence = Geofence(self.plans.fences)
        self.failsafes = Failsafes()
        self.battery = Level.FINE
        self.mode = self.intended = self._after_flight = Mode.HOLD
        self.fly_by(Px4Guidance(steering=self.steering, mission=self.mission))
        self.parameters.on_change(("MPC_",), self.guidance.retune)
        self.had_sticks = False
        self._flew = False
        self._armed_at_s = self._setpoint_at_s = self._gcs_at_s = NEVER_S

    @property
    def has_position(self) -> bool:
        return self.boot.stage.position and self.estimate.has_position

    @property
    def has_sticks(self) -> bool:
        """Whether a pilot holds the sticks."""
        return self.now_s <= self._sticks_until_s and self._sticks_until_s > self.started_at_s

    @property
    def hears_gcs(self) -> bool:
        """Whether a ground station is there: any that says it is one."""
        return self.now_s - self._gcs_at_s <= self.parameters["COM_DL_LOSS_T"] + TIME_SLACK_S

    @property
    def hears_setpoints(self) -> bool:
        """Whether setpoints come often enough for OFFBOARD."""
        return self.now_s - self._setpoint_at_s <= self.parameters["COM_OF_LOSS_T"] + TIME_SLACK_S

    @property
    def charge_share(self) -> float:
        """What the battery says it has left; a simulated one never says less than SIM_BAT_MIN_PCT."""
        capacity_mah = max(1.0, self.parameters["BAT1_CAPACITY"])
        left = 1.0 - self.charge.consumed_mah / capacity_mah
        return max(left, min(1.0, self.parameters["SIM_BAT_MIN_PCT"] / 100.0), 0.0)

    @property
    def setpoint_ned_m(self) -> Vec3 | None:
        """Where it is on its way to, if it says so."""
        return self.guidance.setpoint.position_ned_m

    # What a ground station asks for. Each returns whether it was done.

    def set_mode(self, number: int) -> bool:
        """Choose a mode: on the ground any, armed one that can be flown."""
        if number not in Mode.__members__.values():
            return False
        mode = Mode(number)
        if self.armed and not can_run(self, mode):
            return False
        if mode is not self.intended or self.failsafes.active:
            self.failsafes.take_over()
            self._intend(mode)
        return True

    def arm(self, reason: str = EXTERNAL) -> bool:
        if self.armed:
            return True
        reasons = complaints(self, self.intended)
        if reasons:
            self.say(CRITICAL, "Arming denied: Resolve system health failures first")
            for text in reasons:
                self.say(CRITICAL, f"Preflight Fail: {text}")
            return False
        self.armed = self.announce = True
        self._flew = False
        self.had_sticks = self.has_sticks
        self._armed_at_s = self._idle_since_s = self.now_s
        if self.parameters["COM_HOME_EN"]:
            self.set_home(None)
        self.guidance.enter(self.mode, self.now_s)
        self.say(INFO, f"Armed by {reason}")
        return True

    def disarm(self, reason: str = EXTERNAL, *, forced: bool = False) -> bool:
        if not self.armed:
            return True
        if self.flying and not forced:
            self.say(CRITICAL, "Disarming denied: not landed")
            return False
        self.armed = self.flying = self.steering.throttle_up = False
        self.announce = True
        self.failsafes.rest()
        self.guidance.takeoff_altitude_m = None
        self.mission.stop()
        self._intend(self._after_flight)
        self.say(INFO, f"Disarmed by {reason}")
        return True

    def take_off(self, altitude_m: float | None) -> bool:
        """Choose TAKEOFF, to `altitude_m` above the sea or (None) a little above here; armed it begins at once."""
        if self.armed and not can_run(self, Mode.TAKEOFF):
            return False
        again = self.mode is Mode.TAKEOFF
        self.guidance.takeoff_altitude_m = altitude_m
        self.set_mode(Mode.TAKEOFF)
        if again:
            self.guidance.enter(Mode.TAKEOFF, self.now_s)
        return True

    def start_mission(self) -> bool:
        """MISSION_START: choose it, and arm."""
        return self.set_mode(Mode.MISSION) and self.arm(MISSION_START)

    def stop_motors(self) -> None:
        """A failsafe's last resort, and a ground station's: wherever it is."""
        self.disarm(FAILSAFE, forced=True)

    def fly_item(self, item: Item, there: bool) -> bool:
        """Not an order that PX4 takes."""
        return False

    def reboot(self) -> bool:
        """Start over where it stands, with the parameters and plans it has. Not while armed.

        Its local frame stays where it was at power-on; a real one would begin a new one here.
        """
        if self.armed:
            return False
        self.started_at_s = self.now_s
        self.boot.restart()
        self.failsafes = Failsafes()
        self.battery = Level.FINE
        self.mission.reset()
        self.mission.complete = False
        self.steering.home_ned_m = self.steering.place_ned_m
        self._armed_at_s = self._setpoint_at_s = self._gcs_at_s = NEVER_S
        self._intend(Mode.HOLD)
        self.announce = self.restarted = True
        return True

    # What it takes in without an answer.

    def hear_gcs(self) -> None:
        self._gcs_at_s = self.now_s

    def hear_setpoint(self, asked: Trajectory | Attitude | None) -> None:
        """A sign of life for OFFBOARD, and (unless None) what to fly."""
        self._setpoint_at_s = self.now_s
        if asked is not None:
            self.guidance.follow(asked)

    def take_sticks(self, sticks: Sticks) -> None:
        super().take_sticks(sticks)
        self._sticks_until_s = self.now_s + self.parameters["COM_RC_LOSS_T"]
        self.had_sticks = True

    # Time.

    def watch(self) -> None:
        self._watch_ground()
        if isinstance(self.guidance.navigator, Lift) and self.guidance.navigator.done:
            self._end_takeoff(self.guidance.navigator)
        self.geofence.watch(self)
        self.failsafes.watch(self)

    def fly_mode(self, mode: Mode) -> None:
        """Fly `mode` from now on."""
        if mode is self.mode:
            return
        self.mode = mode
        self.announce = True
        self.guidance.enter(mode, self.now_s)

    def reject(self, mode: Mode) -> None:
        """Say that `mode` cannot be flown."""
        self.say(CRITICAL, f"Switching to {MODES[mode].word} is currently not available")

    def touch_down(self, speed_m_s: float) -> None:
        """It says so when its land detector believes it."""

    def _intend(self, mode: Mode) -> None:
        """Fly `mode`, for that is wanted; once disarmed, it waits in the last one that it may be armed in."""
        self.intended = mode
        if MODES[mode].armable:
            self._after_flight = mode
        self.fly_mode(mode)

    def _end_takeoff(self, lift: Lift) -> None:
        """Stay where it led, or go on with the mission."""
        goes_on = self.parameters["COM_TAKEOFF_ACT"] == 1.0 and can_run(self, Mode.MISSION)
        self._intend(Mode.MISSION if goes_on else Mode.HOLD)
        if isinstance(self.guidance.navigator, Hold):
            self.guidance.navigator.go(lift.goal_ned_m)

    def _watch_ground(self) -> None:
        """Notice takeoff and landing, and disarm what has been on the ground for long enough."""
        if not self.airframe.on_ground:
            if self.flying and not self._flew:
                self._flew = True
                self.say(INFO, "Takeoff detected")
            return
        lifts = self.guidance.taking_off and not self.airframe.tumbling
        if not self.armed or lifts:
            self._idle_since_s = self.now_s
            return
        idle_s = self.now_s - self._idle_since_s + TIME_SLACK_S
        if self.flying and idle_s >= LANDED_AFTER_S:
            self.flying = False
            self.say(INFO, "Landing detected")
        if self.flying:
            return
        delay_s = self.parameters["COM_DISARM_LAND" if self._flew else "COM_DISARM_PRFLT"]
        settled_s = idle_s - LANDED_AFTER_S if self._flew else self.now_s - self._armed_at_s
        if 0.0 <= delay_s <= settled_s + TIME_SLACK_S:
            self.disarm(LANDING if self._flew else PREFLIGHT)
