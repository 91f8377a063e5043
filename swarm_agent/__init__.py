"""One agent: the brain (`bcmommt`), its hands (`autopilot`), and the two joined (`agent`). Imports `comms` alone.

What an agent decides that sees one target fleeing east, and nothing else in the world:

>>> from comms.arena import disc
>>> from swarm_agent.bcmommt.belief import begin_tick, new_table, see
>>> from swarm_agent.bcmommt.params import Call, Capture, Explore, Gate, Params, Predictor
>>> from swarm_agent.bcmommt.step import decide, new_mind
>>> params = Params(
...     arena=disc(30.0), tick_s=0.1, sensing_range_m=5.5, agent_speed_m_s=0.4, target_speed_m_s=0.3, standoff_m=0.0,
...     turn_time_s=0.5, horizon_s=20.0, help_margin_s=40.0, tag_lease_s=0.5, help_lease_s=1.0, memory_s=60.0,
...     follow_gain_per_s=1.0, predictor=Predictor.DIRECT, call=Call.ALL_BUT_NEAREST, gate=Gate.ALWAYS,
...     capture=Capture.INTERCEPT, commitment=True, explore=Explore.PERSISTENT_WALK,
... )
>>> table, mind = new_table(n_targets=1, n_agents=1, n_cells=0), new_mind(1.0, 0.0)
>>> for tick in range(2):
...     begin_tick(table)
...     see(table, params, 0, 2.0 + 0.03 * tick, 0.0, 0.0, 0.0, now=0.1 * tick)
...     mind, east, north = decide(table, params, mind, 0, 0.0, 0.0, 0.1 * tick, 1, tick)
>>> mind.mode.name, table.tagged, (east, north)
('FOLLOW', [True], (0.4, 0.0))
"""
