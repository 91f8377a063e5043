"""All that watches over a vehicle, and the watch for its ground station.

Each watch looks once a tick, says what ArduCopter says, and leaves what to fly to `actions`. The battery is watched in
`battery_failsafe`, the estimate in `ekf_check`, the airframe in `crash_check`.
"""

from __future__ import annotations

from vehicle_sim.autopilot.ardupilot.safety.actions import Action, fail
from vehicle_sim.autopilot.ardupilot.safety.battery import BatteryFailsafe, Level
from vehicle_sim.autopilot.ardupilot.safety.crash_check import CrashCheck
from vehicle_sim.autopilot.ardupilot.safety.ekf_check import EkfCheck
from vehicle_sim.autopilot.ardupilot.watched import Watched
from vehicle_sim.autopilot.severity import WARNING

# FS_GCS_ENABLE -> what to do; values that are not here return, as ArduCopter does.
GCS_ACTIONS: dict[int, Action] = {
    0: Action.NONE,
    1: Action.RTL,
    3: Action.SMART_RTL_OR_RTL,
    4: Action.SMART_RTL_OR_LAND,
    5: Action.LAND,
    7: Action.BRAKE_OR_LAND,
}


class GcsFailsafe:
    """Whether the ground station that SYSID_MYGCS names is still heard, once it was."""

    def __init__(self) -> None:
        self.active = False
        self._heard_at_s: float | None = None

    def hear(self, now_s: float) -> None:
        self._heard_at_s = now_s

    def watch(self, pilot: Watched) -> None:
        """Act FS_GCS_TIMEOUT after its last heartbeat; say so when it is back."""
        enabled = int(pilot.parameters["FS_GCS_ENABLE"])
        if not enabled or self._heard_at_s is None:
            return
        lost = pilot.now_s - self._heard_at_s > pilot.parameters["FS_GCS_TIMEOUT"]
        if lost is self.active:
            return
        self.active = lost
        pilot.announce = True
        if lost:
            fail(pilot, "GCS", GCS_ACTIONS.get(enabled, Action.RTL))
        else:
            pilot.say(WARNING, "GCS Failsafe Cleared")


class Failsafes:
    """All that watches over one vehicle."""

    def __init__(self) -> None:
        self.gcs = GcsFailsafe()
        self.battery = BatteryFailsafe()
        self.ekf = EkfCheck()
        self.crash = CrashCheck()

    @property
    def active(self) -> bool:
        """Whether HEARTBEAT.system_status is CRITICAL."""
        return self.gcs.active or self.ekf.active or self.battery.level is not Level.FINE

    def watch(self, pilot: Watched) -> None:
        """Look at everything once."""
        self.gcs.watch(pilot)
        self.battery.watch(pilot)
        self.ekf.watch(pilot)
        self.crash.watch(pilot)
