"""The world: simulated autopilots (`autopilot`, `flight`, `sensors`, `wind`, `battery`), targets (`targets`, `herd`,
`tracks`), and what is seen of them (`sensing`, `world`). Imports `comms` alone.

A vehicle boots, on the mission's clock, and says so in MAVLink:

>>> from comms.frames import GeoPoint
>>> from comms.mavlink import Endpoint
>>> from vehicle_sim.autopilot import SimulatedVehicle
>>> from vehicle_sim.vehicle import VehicleConfig
>>> vehicle = SimulatedVehicle(config=VehicleConfig(boot_s=2.0), system_id=3, home=GeoPoint(-35.36, 149.17, 584.0))
>>> ground = Endpoint(system_id=255)
>>> texts = []
>>> for tick in range(1, 31):
...     for message in ground.receive(vehicle.tick(0.1 * tick, b"")):
...         if message.get_type() == "STATUSTEXT":
...             texts.append(message.text)
>>> texts[0], texts[-1]
('Calibrating barometer', 'EKF3 IMU1 is using GPS')
>>> vehicle.truth.on_ground
True
"""
