"""MAVSDK, MAVProxy and mavutil fly simulated vehicles: `make test-clients`, in an environment of their own.

Each `*_session` is a program that takes the address of a vehicle and flies it step by step; it fails at the first step
that does not go as with a real ArduCopter. `__main__` runs them all against `swarm sim`, and again with a message
withheld on the way, where they must fail.
"""
