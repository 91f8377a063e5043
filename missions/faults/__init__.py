"""Faults as part of a mission: what is wrong when, how it is done to vehicles and links, and what it cost.

    schedule = Schedule(mission)
    schedule.at(tick).dead, schedule.at(tick).links   # ticks since the mission began

`schedule` is values alone, the same in every process that knows the mission: the world asks it for the links and for
whom nobody waits, an agent's side for its own computer and vehicle. `breakage` is the table of what breaks in a
vehicle, `breaker` does it. `detection` is the table of signs by which the swarm notices; `costs` puts them beside
coverage, for the report. `consistency` has the rules between faults and other keys, `words` how a fault is told.

Another kind: its section in `missions.mission.faults`, what it does in `schedule` or `breakage`, its sign in
`detection`.
"""
