"""A simulated autopilot, sans-io: MAVLink bytes in, MAVLink bytes out, on the mission's clock.

    from vehicle_sim.autopilot import SimulatedVehicle
    from vehicle_sim.vehicle import VehicleConfig

    vehicle = SimulatedVehicle(config=VehicleConfig(), system_id=3, home=home, seed=7)
    wire_out = vehicle.tick(now_s, wire_in)  # wire_in acts from the last tick on
    vehicle.truth.position_ned_m             # north, east, down of its own home, meters

`ardupilot` is an ArduCopter and `px4` a PX4: each has its `modes`, `commands`, `parameters.csv`, `boot` sequence and
`telemetry`, tables to read first, and what watches over it. `flavors` lists them, `flavor` says where they differ on
the wire. All else is what they share. `core` is any autopilot without its wire: `body` is the machine underneath,
`faults` how SIM_* parameters break it, `estimate` what is believed of it. `guidance` turns a mode into a demand,
`navigation` has the modes that flavors share, over the moves of `steering`; `setpoints` reads what it is asked.
`plans` keeps missions, fences and rally points and carries them up and down, `mission` is the course through one.
"""

from vehicle_sim.autopilot.vehicle import SimulatedVehicle

__all__ = ["SimulatedVehicle"]
