"""What the autopilot does by itself when something is lost: who watches, what is said, what is flown then.

Every failsafe ends in an `Action`, and `ACTION_MODES` says what that is; `act` does it. Texts are ArduCopter's.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

from vehicle_sim.autopilot.modes import Mode
from vehicle_sim.autopilot.severity import WARNING

if TYPE_CHECKING:
    from vehicle_sim.autopilot.core import Autopilot


class Action(IntEnum):
    """What to do about a failsafe, numbered as BATT_FS_LOW_ACT counts."""

    NONE = 0
    LAND = 1
    RTL = 2
    SMART_RTL_OR_RTL = 3
    SMART_RTL_OR_LAND = 4
    TERMINATE = 5
    BRAKE_OR_LAND = 7


# The modes to try, in order. TERMINATE stops the motors wherever it is.
ACTION_MODES: dict[Action, tuple[Mode, ...]] = {
    Action.NONE: (),
    Action.LAND: (Mode.LAND,),
    Action.RTL: (Mode.RTL, Mode.LAND),
    Action.SMART_RTL_OR_RTL: (Mode.SMART_RTL, Mode.RTL, Mode.LAND),
    Action.SMART_RTL_OR_LAND: (Mode.SMART_RTL, Mode.LAND),
    Action.TERMINATE: (),
    Action.BRAKE_OR_LAND: (Mode.BRAKE, Mode.LAND),
}

# FS_GCS_ENABLE -> what to do; values that are not here return, as ArduCopter does.
GCS_ACTIONS: dict[int, Action] = {
    0: Action.NONE,
    1: Action.RTL,
    3: Action.SMART_RTL_OR_RTL,
    4: Action.SMART_RTL_OR_LAND,
    5: Action.LAND,
    7: Action.BRAKE_OR_LAND,
}


def act(pilot: Autopilot, action: Action) -> None:
    """Fly what `action` asks for: the first of its modes that can be entered."""
    if action is Action.TERMINATE:
        pilot.disarm(forced=True)
    for mode in ACTION_MODES[action]:
        if pilot.set_mode(mode):
            return


class GcsFailsafe:
    """Whether the ground station that SYSID_MYGCS names is still heard, once it was."""

    def __init__(self) -> None:
        self.active = False
        self._heard_at_s: float | None = None

    def hear(self, now_s: float) -> None:
        self._heard_at_s = now_s

    def watch(self, pilot: Autopilot) -> None:
        """Act FS_GCS_TIMEOUT after its last heartbeat; say so when it is back."""
        enabled = int(pilot.parameters["FS_GCS_ENABLE"])
        if not enabled or self._heard_at_s is None:
            return
        lost = pilot.now_s - self._heard_at_s > pilot.parameters["FS_GCS_TIMEOUT"]
        if lost is self.active:
            return
        self.active = lost
        pilot.announce = True
        if not lost:
            pilot.say(WARNING, "GCS Failsafe Cleared")
        elif not pilot.armed:
            pilot.say(WARNING, "GCS Failsafe")
        elif not pilot.flying:
            pilot.say(WARNING, "GCS Failsafe - Disarming")
            pilot.disarm(forced=True)
        else:
            pilot.say(WARNING, "GCS Failsafe")
            act(pilot, GCS_ACTIONS.get(enabled, Action.RTL))


class Failsafes:
    """All that watches over one vehicle."""

    def __init__(self) -> None:
        self.gcs = GcsFailsafe()

    @property
    def active(self) -> bool:
        """Whether HEARTBEAT.system_status is CRITICAL."""
        return self.gcs.active

    def watch(self, pilot: Autopilot) -> None:
        """Look at everything once."""
        self.gcs.watch(pilot)
