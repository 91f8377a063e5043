"""The flavors of simulated autopilots, by name."""

from __future__ import annotations

from vehicle_sim.autopilot.ardupilot.flavor import ARDUPILOT
from vehicle_sim.autopilot.flavor import Flavor
from vehicle_sim.autopilot.px4.flavor import PX4
from vehicle_sim.vehicle import FlavorName

FLAVORS: dict[FlavorName, Flavor] = {"ardupilot": ARDUPILOT, "px4": PX4}
