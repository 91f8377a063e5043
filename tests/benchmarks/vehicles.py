"""`make bench-vehicles`: what a simulated vehicle costs. Processor time of one process, medians over several runs.

    python -m tests.benchmarks.vehicles [--runs N] [--vehicles N] [--seconds S]

Every vehicle flies by a velocity setpoint at 10 Hz and reports position and attitude at 10 Hz and the rest at 1 Hz,
in ticks of 0.1 s; a PX4 reports what it sends unasked besides. A real ArduCopter SITL flies 57 vehicle-seconds in a
second of one core.
"""

from __future__ import annotations

import argparse
import os
import platform
import time
from statistics import median
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect
from rich.console import Console
from rich.table import Table

from comms.frames import GeoPoint
from comms.mavlink import Endpoint
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.vehicle import FlavorName, VehicleConfig
from vehicle_sim.wind import Wind

TICK_S = 0.1
SYSTEM = 1  # of every vehicle: each hears the same
FAST_IDS = (30, 32, 33)  # ATTITUDE, LOCAL_POSITION_NED, GLOBAL_POSITION_INT
SLOW_IDS = (0, 1, 2, 24, 49, 74, 85, 147, 148, 193, 242, 245)  # health, GPS, battery, estimate, home ...
READY_TICKS, CLIMB_TICKS = 20, 100
RACE_AGAINST = 57.0  # vehicle-seconds a core-second of a real SITL


def command(number: int, *params: float) -> dialect.MAVLink_message:
    return dialect.MAVLink_command_long_message(SYSTEM, 1, number, 0, *params, *[0.0] * (7 - len(params)))


HOME = GeoPoint(47.397742, 8.545594, 488.1)
# What leads to flying by setpoints: commands before the takeoff, its altitude, and commands behind it.
DEPARTURES: dict[FlavorName, tuple[tuple[Any, ...], float, tuple[Any, ...]]] = {
    "ardupilot": ((command(176, 1, 4),), 10.0, ()),
    "px4": ((), HOME.altitude_m + 10.0, (command(176, 1, 6),)),
}


class Fleet:
    """Vehicles in the air, all streaming."""

    def __init__(self, count: int, config: VehicleConfig) -> None:
        self.ticks = 0
        self.vehicles = [SimulatedVehicle(config=config, system_id=SYSTEM, home=HOME, seed=k) for k in range(count)]
        self._ground = Endpoint(system_id=255)
        for _ in range(READY_TICKS):
            self.tick()
        before, height_m, behind = DEPARTURES[config.flavor]
        self.tick(*before, command(400, 1), command(22, 0, 0, 0, 0, 0, 0, height_m))
        for _ in range(CLIMB_TICKS):
            self.tick()
        self.fly(1)
        self.tick(*behind)
        rates = [command(511, number, 1e5 if number in FAST_IDS else 1e6) for number in (*FAST_IDS, *SLOW_IDS)]
        self.tick(*rates)
        if not all(vehicle.truth.position_ned_m[2] < -5.0 for vehicle in self.vehicles):
            raise RuntimeError("not every vehicle took off")

    def tick(self, *messages: dialect.MAVLink_message) -> int:
        """One tick of every vehicle; the bytes they said."""
        for message in messages:
            self._ground.send(message)
        wire = self._ground.take()
        self.ticks += 1
        return sum(len(vehicle.tick(self.ticks * TICK_S, wire)) for vehicle in self.vehicles)

    def fly(self, ticks: int) -> None:
        for tick in range(ticks):
            north = 3.0 if tick // 50 % 2 else -3.0
            self.tick(
                dialect.MAVLink_set_position_target_local_ned_message(
                    0, 0, 1, 1, 0xDC7, 0, 0, 0, north, 1.0, 0.0, 0, 0, 0, 0, 0
                )
            )


def microseconds(count: int, seconds: float, config: VehicleConfig) -> float:
    """Processor microseconds of one vehicle-second."""
    fleet = Fleet(count, config)
    ticks = round(seconds / TICK_S)
    began_s = time.process_time()
    fleet.fly(ticks)
    return 1e6 * (time.process_time() - began_s) / (count * ticks * TICK_S)


CONFIGS: dict[str, VehicleConfig] = {
    "simulated": VehicleConfig(),
    "simulated, in gusts": VehicleConfig(wind=Wind(speed_m_s=3.0, gust_m_s=1.0)),
    "ideal": VehicleConfig(kind="ideal"),
    "simulated, px4": VehicleConfig(flavor="px4"),
}


def main() -> None:
    parser = argparse.ArgumentParser(description="What a simulated vehicle costs.")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--vehicles", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=20.0)
    options = parser.parse_args()
    console = Console()
    console.print(
        f"{options.vehicles} vehicles, {options.seconds:.0f} s each, {options.runs} runs; "
        f"Python {platform.python_version()}, {os.cpu_count()} cores"
    )
    table = Table("vehicle", "us a vehicle-second", "least", "most", "100 at real time", "times SITL", box=None)
    for name, config in CONFIGS.items():
        costs = [microseconds(options.vehicles, options.seconds, config) for _ in range(options.runs)]
        cost = median(costs)
        table.add_row(
            name, f"{cost:.0f}", f"{min(costs):.0f}", f"{max(costs):.0f}", f"{cost * 1e-4:.0%} of a core",
            f"{1e6 / cost / RACE_AGAINST:.0f}",
        )  # fmt: skip
    console.print(table)


if __name__ == "__main__":
    main()
