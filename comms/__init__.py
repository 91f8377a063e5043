"""What is said, and how it travels.

Two agents 10 m apart and a third out of range, on real zenoh without a network:

>>> from comms.air import Air, LinkModel
>>> from comms.keys import Keys
>>> from comms.messages import Frame, Tag
>>> from comms.radio import Radio
>>> from comms.session import open_local_bus
>>> with open_local_bus() as bus:
...     keys = Keys("tour")
...     air = Air(bus, keys=keys, model=LinkModel(range_m=20.0), n_agents=3, tick_s=0.1, seed=1)
...     radios = [Radio(bus, keys=keys, uid=uid) for uid in range(3)]
...     tag = Tag(target=4, x_m=1.0, y_m=2.0, vx_m_s=0.3, vy_m_s=0.0, distance_m=0.5)
...     radios[0].send(Frame(0, 1, 0.0, 0.5, (0.0, 0.0, 10.0), (0.3, 0.0, 0.0), tags=(tag,)))
...     delivered = air.carry(0, [(0.0, 0.0), (10.0, 0.0), (50.0, 0.0)])
...     heard = [[frame.src for frame in radio.drain(0.1)] for radio in radios]
>>> delivered, heard
(1, [[], [0], []])

`messages` and `codec` are the frames, `keys` the topics, `session` zenoh, `credentials` who one is there and `access`
what one may do, `mailbox` how one waits for many, `air` and `link` the medium, `radio` an agent's end of it, `field`
one without an air, `turns` who waits how long in either, `sight` what a detector on board says; `mavlink` is one end of
a MAVLink link, `framing` the layout of its frames, `signing` who is believed on it, and `transport` how its bytes leave
the process; `status` is what observers are told; `frames`, `arena`, `chance` and `clock` are the common ground:
coordinates, the area, randomness and pace. Imports no sibling.
"""
