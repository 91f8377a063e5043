"""The simulated PX4, as its source says it behaves (1.15): what is its own beside what all autopilots here share.

`commander` is the autopilot: modes (`modes`), whether one can be flown and armed in (`checks`), and what happens when
something fails (`failsafes`, `geofence`). `guidance` says which class of `navigation` flies a mode. `commands`,
`setpoints`, `hearing`, `plans`, `parameter_protocol`, `telemetry` and `streams` are its side of the wire, and `flavor`
joins them. `parameters.csv` is the table of its parameters; `failures` is what MAV_CMD_INJECT_FAILURE can break.
"""
