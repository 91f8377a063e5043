"""Composes agents, vehicles, world and radio into missions, and flies, reports and records them. Imports all packages.

A short flight of two agents over two targets, as fast as possible:

>>> from comms.clock import Lockstep
>>> from comms.session import open_local_bus
>>> from missions.flight import Flight
>>> from missions.load import load_mission
>>> from missions.metrics import Metrics
>>> from missions.overrides import Override
>>> changes = ["agents.count=2", "targets.count=2", "duration_s=5", "agents.altitude.base_m=3"]
>>> mission = load_mission("narrow", overrides=[Override(text) for text in changes])
>>> metrics = Metrics()
>>> with open_local_bus() as bus:
...     flight = Flight(mission, bus)
...     flight.run(pace=Lockstep(), observers=[metrics], stop=lambda: False)
>>> flight.complete, flight.ticks_flown, metrics.faults
(True, 50, [])

`mission`, `load` and `library` are mission files; `compose` and `flight` fly them; `observation` is what observers see,
among them `metrics`, `progress` and `recording`; `cli` is the command line, `launch` the shell around a flight.
"""
