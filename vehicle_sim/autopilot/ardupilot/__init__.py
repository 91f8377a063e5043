"""The simulated ArduCopter, 4.5.5 as recorded: what is its own beside what all autopilots here share.

`copter` is the autopilot: modes (`modes`), arming and what it says; `safety` is all that watches over it. `guidance`
says which class of `navigation` flies a mode. `commands`, `hearing`, `parameter_protocol`, `telemetry` and `streams`
are its side of the wire, and `flavor` joins them. `boot` is its power-up, `parameters.csv` its table of parameters.
"""
