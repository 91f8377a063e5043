"""Faults as part of a mission: what is wrong when, how it is done to vehicles and links, and what it cost.

    schedule = Schedule(mission)
    schedule.at(tick).dead, schedule.at(tick).links   # ticks since the mission began

`schedule` is values alone, the same in every process that knows the mission; `breakage` is the table of what breaks in
a vehicle; `consistency` has the rules between faults and other keys.
"""
