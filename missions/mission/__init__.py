"""What a mission is: the typed, immutable value that a mission file becomes.

    mission = Mission(name="demo", agents=Agents(count=4))
    mission.agents.sensing.range_m, mission.targets.motion, mission.policy.help_margin_s

Every key has its default here and nowhere else, each section in a file of its own. The limits of one key stand here;
those between keys are in `missions.rules`, and `missions.load` reports both. Positions are ENU meters about `home`.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from missions.mission.agents import AgentDeployment, Agents, Altitude, Sensing
from missions.mission.arena import Arena, Disc, Home, Rectangle
from missions.mission.faults import Faults
from missions.mission.part import NAME, Allowed, Name, NonNegative, Part, Positive
from missions.mission.policy import Policy
from missions.mission.radio import Radio
from missions.mission.safety import ArenaFence, CircleFence, PolygonFence, Safety
from missions.mission.targets import MovingTargets, TargetDeployment, Targets, TrackTargets
from missions.mission.vehicle import MOST_SYSTEMS, Battery, Limits, Vehicle, Wind, simulated_system_id

__all__ = [
    "MOST_SYSTEMS",
    "NAME",
    "AgentDeployment",
    "Agents",
    "Allowed",
    "Altitude",
    "ArenaFence",
    "Battery",
    "CircleFence",
    "Disc",
    "Home",
    "Limits",
    "Mission",
    "MovingTargets",
    "Name",
    "NonNegative",
    "Part",
    "Policy",
    "PolygonFence",
    "Positive",
    "Radio",
    "Rectangle",
    "Safety",
    "Sensing",
    "TargetDeployment",
    "TrackTargets",
    "Vehicle",
    "Wind",
]


class Mission(Part):
    """A whole mission: who flies where, over what, and how it decides."""

    name: Name
    """Names the mission in reports and recordings."""
    description: str = ""
    """One line for people."""
    seed: Annotated[int, Field(ge=0, le=4294967295)] = 1
    """All chance comes from this number."""
    duration_s: Positive = 240.0
    """How long targets are observed, from when every agent is on its layer."""
    tick_s: Annotated[float, Field(ge=0.01, le=1)] = 0.1
    """Time from one decision to the next."""
    arena: Arena = Disc()
    """Where targets live: they never leave it."""
    home: Home = Home()
    """Geographic place of the local origin."""
    agents: Agents = Agents()
    """The drones."""
    targets: Targets = MovingTargets()
    """What is observed."""
    radio: Radio = Radio()
    """What agents hear of each other."""
    policy: Policy = Policy()
    """How agents decide."""
    vehicle: Vehicle = Vehicle()
    """What carries an agent."""
    safety: Safety = Safety()
    """What every agent keeps to."""
    faults: Faults = ()
    """What goes wrong, and when."""

    def link(self, uid: int) -> str | None:
        """Where agent `uid`'s vehicle is reached; None where it is simulated."""
        return self.vehicle.links[uid] if self.vehicle.links else None

    def system_id(self, uid: int) -> int | None:
        """The MAVLink system id of agent `uid`'s vehicle; None where the vehicle tells."""
        if self.link(uid) is None:
            return simulated_system_id(uid)
        return self.vehicle.system_ids[uid] if self.vehicle.system_ids else None

    @property
    def in_real_time(self) -> bool:
        """Whether a vehicle flies elsewhere, where time does not wait."""
        return any(self.vehicle.links)

    @property
    def target_sensing_range_m(self) -> float:
        """How far a target notices an agent: its own range, or else the agents'."""
        own = self.targets.sensing_range_m if isinstance(self.targets, MovingTargets) else None
        return max(self.agents.sensing_ranges_m) if own is None else own

    @property
    def standoff_m(self) -> float:
        """How far behind a target its follower flies: a sector looks ahead, and does not see what is right below."""
        if self.policy.standoff_m is not None:
            return self.policy.standoff_m
        sensing = self.agents.sensing
        return sensing.range_m / 3 if sensing.field_of_view == "sector" and sensing.opening_deg < 360 else 0.0
