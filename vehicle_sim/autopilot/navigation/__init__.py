"""How each flight mode flies, one small class a file: from what the mode knows to a velocity demand, step by step.

`navigator` says what a mode is to the rest; `takeoff` is what any mode with a takeoff begins with. `guidance`, next
door, and that of each flavor, has the table of which class flies which mode.
"""
