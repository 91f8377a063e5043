"""An ArduCopter as those see it who watch over it: what any autopilot has, its mode, and a way to stop it."""

from __future__ import annotations

from abc import abstractmethod

from vehicle_sim.autopilot.ardupilot.guidance import CopterGuidance
from vehicle_sim.autopilot.ardupilot.modes import Mode
from vehicle_sim.autopilot.core import Autopilot


class Watched(Autopilot):
    """What `safety` knows of a `Copter`."""

    mode: Mode
    guidance: CopterGuidance

    @property
    @abstractmethod
    def outside(self) -> str:
        """The fences that it is outside of, as texts name them; empty: none."""

    @abstractmethod
    def disarm(self, *, forced: bool) -> bool:
        """Motors off; in flight only if `forced`. Returns whether they are."""
