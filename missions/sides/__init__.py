"""The two sides of a tick, which one process joins by calls and many processes by messages.

    world = WorldSide(mission, bus)                      # targets, sensing, air, phases: what nobody flies
    crew = agent_sides(mission, radios, n_targets=len(world.world.places))
    world.meet([side.hello() for side in crew])
    while not world.over:
        dones = [side.tick(cue) for side, cue in zip(crew, world.cue(late_s))]
        observation = world.conclude(dones)
        world.turn(stop=False)

What passes between them is in `exchange`: a `Cue` from the world to an agent, a `Done` back. `medium` is what carries
the agents' frames: an air of the world's, or radios of which it only hears. `phases` is the order of the whole:
prepare, mission, return, done.
"""
