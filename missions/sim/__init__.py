"""`swarm sim`: one vehicle in real time, where ArduCopter SITL would listen.

`options` reads the command line; `session` is the shell with clock, signals and terminal.
"""
