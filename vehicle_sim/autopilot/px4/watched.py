"""A PX4 as those see it who watch over it: what any autopilot has, whom it hears, and what it can be made to do."""

from __future__ import annotations

from abc import abstractmethod

from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.px4.battery import Level
from vehicle_sim.autopilot.px4.geofence import Geofence
from vehicle_sim.autopilot.px4.modes import Mode


class Watched(Autopilot):
    """What `checks` and `failsafes` know of a `Commander`.

    Attributes:
        intended: the mode somebody chose; `mode` is another while a failsafe acts.
        had_sticks: a pilot held the sticks since it was armed.
        battery: how bad it is; it does not recover before the next power-on.
    """

    mode: Mode
    intended: Mode
    had_sticks: bool
    battery: Level
    geofence: Geofence

    @property
    @abstractmethod
    def has_sticks(self) -> bool:
        """Whether a pilot holds the sticks."""

    @property
    @abstractmethod
    def hears_gcs(self) -> bool:
        """Whether a ground station is there: any that says it is one."""

    @property
    @abstractmethod
    def hears_setpoints(self) -> bool:
        """Whether setpoints come often enough for OFFBOARD."""

    @property
    @abstractmethod
    def charge_share(self) -> float:
        """What the battery says it has left; a simulated one never says less than SIM_BAT_MIN_PCT."""

    @abstractmethod
    def fly_mode(self, mode: Mode) -> None:
        """Fly `mode` from now on."""

    @abstractmethod
    def stop_motors(self) -> None:
        """A failsafe's last resort, and a ground station's: wherever it is."""
