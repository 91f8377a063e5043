"""The hand that breaks a simulated vehicle as a schedule has it."""

from __future__ import annotations

from missions.faults.schedule import Schedule
from vehicle_sim.autopilot import SimulatedVehicle


class Breaker:
    """Breaks one vehicle, and mends it: whatever it has changed is as it was once no fault asks for the change."""

    def __init__(self, vehicle: SimulatedVehicle) -> None:
        self._vehicle = vehicle
        self._last: int | None = None  # tick: in real time some may be skipped
        self._sound: dict[str, float] = {}  # what a parameter was before it was touched

    def apply(self, faults: Schedule, uid: int, tick: int | None) -> None:
        """Let the vehicle of agent `uid` have what the schedule has for it at this tick, and nothing else."""
        if tick is not None:
            if faults.reboots(uid, tick, since=tick - 1 if self._last is None else self._last):
                self._vehicle.lose_power()
            self._last = tick
        wanted, parameters = faults.at(tick).breakage.get(uid, {}), self._vehicle.autopilot.parameters
        for name in [name for name in self._sound if name not in wanted]:
            parameters.suffer(name, self._sound.pop(name))
        for name, value in wanted.items():
            self._sound.setdefault(name, parameters[name])
            if parameters[name] != value:
                parameters.suffer(name, value)
