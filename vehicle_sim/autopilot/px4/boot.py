"""Power-up to armable: what a PX4 knows at each moment. It says little; the times are those of its SITL, roughly."""

from __future__ import annotations

from vehicle_sim.autopilot.boot import Script, Stage
from vehicle_sim.vehicle import READY_S as READY

READY_S = READY["px4"]

_COLD = ("ekf2 missing data",)
_NO_HEIGHT = ("height estimate not stable", "No valid position estimate", "Home position not set")
_NO_HOME = ("No valid position estimate", "Home position not set")

STAGES: tuple[Stage, ...] = (
    Stage(0.0, 0, _COLD, booting=True),
    Stage(1.0, 0, _COLD),
    Stage(2.0, 1, _NO_HEIGHT),
    Stage(3.0, 0x25, _NO_HOME, gps_fix=3, satellites=10),
    Stage(8.0, 0x25, ("Home position not set",), gps_fix=3, satellites=10, origin=True),
    Stage(READY_S, 0x33F, gps_fix=3, satellites=10, origin=True, position=True),
)

PX4_BOOT = Script(READY_S, ((READY_S, "Ready for takeoff!"),), STAGES)
