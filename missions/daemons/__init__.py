"""A mission in many processes: the world, its agents, the recorder, on one machine or several.

    swarm world quickstart &                     # targets, air, clock; the others find each other through it
    for n in 0 1 2 3 4 5 6 7 8 9; do swarm agent quickstart --id $n & done
    swarm record quickstart --record out/q.rrd &

Each is a page of shell around the code that runs in one process: `world` around `missions.sides.world`, `agent` around
`missions.sides.agent`, `record` around `missions.recording`. `crew` is the barrier between them, `wire` their messages,
`ending` how they are asked to end, `log` what they say. `plan` is which processes a launch runs, `launcher` runs them.
"""
