"""A simulated autopilot, sans-io: MAVLink bytes in, MAVLink bytes out, on the mission's clock.

    from vehicle_sim.autopilot import SimulatedVehicle
    from vehicle_sim.vehicle import VehicleConfig

    vehicle = SimulatedVehicle(config=VehicleConfig(), system_id=3, home=home, seed=7)
    wire_out = vehicle.tick(now_s, wire_in)  # wire_in acts from the last tick on
    vehicle.truth.position_ned_m             # north, east, down of its own home, meters

Tables to read first: `modes`, `commands`, `parameters.csv`, `streams`, `telemetry`, `arming`, `actions` and the `boot`
sequence. `core` is any autopilot without its wire, `copter` an ArduCopter, and `px4` a room with a PX4; `flavors`
lists the families, and `flavor` says where they differ on the wire. `guidance` turns a mode into a demand, `setpoints`
reads what a ground station asks for. `body` is the machine underneath and `faults` how SIM_* parameters break it;
`estimate` is what the autopilot believes of it, and `failsafes`, `battery_failsafe`, `ekf_check` and `crash_check`
watch over both.
How each mode flies is in `navigation`, one small class each, over the moves of `steering`. `plans` keeps missions,
fences and rally points and carries them up and down; `mission` is the course through one, `fence` watches the borders.
"""

from vehicle_sim.autopilot.vehicle import SimulatedVehicle

__all__ = ["SimulatedVehicle"]
