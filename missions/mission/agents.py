"""The drones of a mission: how many, what they see, where they start and how high they fly."""

from __future__ import annotations

from math import radians, tan
from typing import Annotated, Literal

from pydantic import Field

from missions.mission.part import NonNegative, Part, Positive

MOST_AGENTS = 1000


class Sensing(Part):
    """What an agent sees of the ground around it."""

    range_m: Positive = 5.5
    """How far, horizontally, an agent sees targets."""
    field_of_view: Literal["omni", "sector", "camera"] = "omni"
    """`omni`: all around; `sector`: ahead, within an angle; `camera`: all around below, as far as a cone reaches."""
    opening_deg: Annotated[float, Field(gt=0, le=360)] = 120.0
    """A sector's whole angle, about the direction of flight."""
    half_angle_deg: Annotated[float, Field(gt=0, le=85)] = 15.0
    """A camera's cone, from its axis to its edge: it sees as far as the agent flies high, times the tangent."""
    identity_error: Annotated[float, Field(ge=0, le=1)] = 0.0
    """Probability that a target seen is taken for another one; drawn for every agent, target and tick."""


class AgentDeployment(Part):
    """Where agents start: at random places in a circle about home."""

    radius_m: Annotated[float, Field(gt=0, le=5000)] = 15.0
    """Radius of the circle in which agents start."""
    spacing_m: NonNegative = 1.0
    """Least distance between two agents' starting places."""


class Altitude(Part):
    """One layer of air for each agent, so that paths may cross. Agent `uid` flies on layer `uid` modulo `layers`."""

    base_m: Annotated[float, Field(ge=2, le=500)] = 10.0
    """Height of the lowest layer above home."""
    layer_m: Positive = 2.0
    """Distance from one layer to the next."""
    layers: Annotated[int, Field(ge=1, le=250)] = 20
    """How many layers there are; more agents than layers share them."""

    def of_agent(self, uid: int) -> float:
        """Height above home at which agent `uid` flies, in meters."""
        return self.base_m + self.layer_m * (uid % self.layers)


class Agents(Part):
    """The drones."""

    count: Annotated[int, Field(ge=1, le=MOST_AGENTS)] = 10
    """How many; more than 250 with ideal vehicles alone, since a MAVLink system id is one byte."""
    speed_m_s: Annotated[float, Field(ge=0.1, le=50)] = 0.4
    """Greatest speed at which agents follow and search."""
    sensing: Sensing = Sensing()
    """What an agent sees."""
    deployment: AgentDeployment = AgentDeployment()
    """Where agents start."""
    altitude: Altitude = Altitude()
    """How high agents fly."""
    may_lose: Annotated[int, Field(ge=0, le=MOST_AGENTS)] = 0
    """How many agents' processes may die, or stop answering, without the mission having failed."""
    world_timeout_s: Annotated[float, Field(ge=0, le=3600)] = 30.0
    """How long an agent whose process does not hear the world's holds still before it flies home."""

    @property
    def sensing_ranges_m(self) -> tuple[float, ...]:
        """How far each agent sees, horizontally, by uid: r_s(v_i)."""
        sensing = self.sensing
        if sensing.field_of_view != "camera":
            return (sensing.range_m,) * self.count
        slope = tan(radians(sensing.half_angle_deg))
        return tuple(self.altitude.of_agent(uid) * slope for uid in range(self.count))
