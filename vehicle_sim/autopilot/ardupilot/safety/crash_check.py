"""Disarms what has tumbled and does not move any more."""

from __future__ import annotations

from math import acos, cos, degrees

from vehicle_sim.autopilot.ardupilot.watched import Watched
from vehicle_sim.autopilot.severity import EMERGENCY
from vehicle_sim.autopilot.steering import TIME_SLACK_S

CRASHED_AFTER_S = 2.0
LEAN_DEG = 30.0  # further than this from what was asked for
STILL_M_S2 = 3.0


class CrashCheck:
    """Watches for a vehicle that lies on the ground and still believes that it flies."""

    def __init__(self) -> None:
        self._since_s: float | None = None

    def watch(self, pilot: Watched) -> None:
        frame = pilot.airframe
        if not frame.tumbling:
            self._since_s = None
            return
        lean_deg = degrees(acos(cos(frame.attitude_rad[0]) * cos(frame.attitude_rad[1])))
        lies = pilot.armed and pilot.flying and frame.on_ground and lean_deg > LEAN_DEG
        if not lies or pilot.parameters["FS_CRASH_CHECK"] == 0.0:
            self._since_s = None
            return
        if self._since_s is None:
            self._since_s = pilot.now_s
        if pilot.now_s - self._since_s >= CRASHED_AFTER_S - TIME_SLACK_S:
            angles = f"AngErr={lean_deg:.0f}>{LEAN_DEG:.0f}"
            pilot.say(EMERGENCY, f"Crash: Disarming: {angles}, Accel=0.0<{STILL_M_S2:.1f}")
            pilot.disarm(forced=True)
