"""The agent's hands: a MAVLink client that takes a vehicle from its first heartbeat to its layer, flies it, and brings
it back. Sans-io: bytes in, bytes out, time an argument.

    pilot = Pilot(PilotConfig(uid=3, system_id=4, home=home, altitude_m=16.0, max_speed_m_s=5.0))
    pilot.listen(now_s, wire_in)                      # each tick: what the vehicle sent
    where = pilot.state.position_m                    # ENU meters in the mission's frame
    wire_out = pilot.act(now_s, Prepare())            # until pilot.state.ready
    wire_out = pilot.act(now_s, Fly((2.0, -1.0)))     # each tick: velocity east, north
    wire_out = pilot.act(now_s, Return())             # until pilot.state.phase is Phase.DONE (or FAILED)
    for event in pilot.take_events(): ...             # the autopilot's texts, refusals, retries

Where to look: `state.Phase` is the state table, `ground`, `airborne` and `ending` are its rows (one small class each),
`preflight` the checklist before arming, `transaction` how a request is sent and answered, `errand` how it is seen
through, `flavors` where autopilots differ. A vehicle that restarts is checked anew (`pilot`); one that somebody else
flies is left alone until it is given back (`airborne.TakenOver`).
"""

from swarm_agent.autopilot.config import PilotConfig
from swarm_agent.autopilot.intent import Fly, Intent, Land, Prepare, Return
from swarm_agent.autopilot.pilot import Pilot
from swarm_agent.autopilot.state import Phase, PilotState

__all__ = ["Fly", "Intent", "Land", "Phase", "Pilot", "PilotConfig", "PilotState", "Prepare", "Return"]
