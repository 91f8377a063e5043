"""MAVSDK's `raw://` connection flies a vehicle in this very process: no socket, no thread of ours but one.

`python -m tests.clients.raw_session`
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from mavsdk import ComponentType, Configuration, Mavsdk

from comms.clock import RealTime
from comms.frames import GeoPoint
from tests.clients.mavsdk_session import Session
from tests.clients.steps import expect, step
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.vehicle import VehicleConfig

TICK_S, SPEED = 0.02, 3.0


@contextmanager
def flying(sdk: Mavsdk) -> Iterator[SimulatedVehicle]:
    """A vehicle whose bytes go to MAVSDK and come from there."""
    vehicle = SimulatedVehicle(config=VehicleConfig(), system_id=1, home=GeoPoint(47.397742, 8.545594, 488.1))
    inbox: list[bytes] = []
    landed = threading.Event()
    sdk.add_any_connection("raw://")
    sdk.subscribe_raw_bytes_to_be_sent(inbox.append)

    def live() -> None:
        pace, tick = RealTime(tick_s=TICK_S, speed=SPEED), 0
        while not landed.is_set():
            tick += 1
            pace.begin(tick)
            count = len(inbox)
            wire = vehicle.tick(tick * TICK_S, b"".join(inbox[:count]))
            del inbox[:count]
            if wire:
                sdk.pass_received_raw_bytes(wire)

    thread = threading.Thread(target=live, daemon=True)
    thread.start()
    try:
        yield vehicle
    finally:
        landed.set()
        thread.join(timeout=5.0)


def main() -> None:
    sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    with flying(sdk) as vehicle:
        found: list[Session] = []
        step("discovery", lambda: found.append(Session(sdk)))
        drone = found[0]
        step("health_all_ok", drone.healthy)
        step("takeoff", drone.take_off)
        step("velocity offboard", drone.fly_velocity)
        step("offboard stopped", drone.stop)
        step("the truth", lambda: expect(vehicle.truth.position_ned_m[1] > 1.0, "it did not fly east"))
        step("land", drone.land)


if __name__ == "__main__":
    main()
