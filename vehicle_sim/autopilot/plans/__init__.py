"""What a ground station uploads and the vehicle keeps: the mission, the fences and the rally points.

`item` is one row of a plan, `commands` the table of what a mission may hold, `store` the three plans with what each
accepts, `transfer` the protocol that carries them up and down.
"""
