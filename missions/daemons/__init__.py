"""A mission in many processes: the world, its agents, the recorder, on one machine or several.

    swarm world quickstart &                     # targets, air, clock; the others find each other through it
    for n in 0 1 2 3 4 5 6 7 8 9; do swarm agent quickstart --id $n & done
    swarm record quickstart --record out/q.rrd &

    swarm status; swarm land --id 3

Each is a page of shell around the code that runs in one process: `world` around `missions.sides.world`, `agent` around
`missions.sides.agent`, `record` around `missions.recording`. `crew` is the barrier between world and agents; `seat` is
what a process keeps of each of its agents, and `contact` what that makes of a world it hears late or not at all. `feed`
is the way from the world to the recorder, `wire` their messages, `joining` how they come to the world, `log` what they
say; `missions.ending` is how they are asked to end.

`processes` is which of them a launch runs, `launcher` runs them. `fleet` is how people speak to vehicles under way,
`questions` keeps what they say, and `orders` is what vehicles make of it. `issue` makes the credentials by which all
know each other, `security` asks for them. `radios` is who shares a radio that a mission names, `airwaves` where
frames of agents go that hear each other directly, `alone` an agent without a world.
`verbs`, `arguments` and `options` are their command lines.
"""
