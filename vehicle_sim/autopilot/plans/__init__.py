"""What a ground station uploads and the vehicle keeps: the mission, the fences and the rally points.

`item` is one row of a plan, `commands` the table of what a mission may hold, `store` a plan with what it accepts,
`keeper` has all three. `transfer` is the protocol that carries one up and down, `desk` where its messages arrive.
"""
