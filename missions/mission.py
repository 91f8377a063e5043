"""What a mission is: the typed, immutable value that a mission file becomes.

    mission = Mission(name="demo", agents=Agents(count=4))
    mission.agents.sensing.range_m, mission.targets.motion, mission.policy.help_margin_s

Every key has its default here and nowhere else. The limits of one key stand here; those between keys are in
`missions.rules`, and `missions.load` reports both. Positions are ENU meters about `home`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import radians, tan
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Discriminator, Field, Tag

from comms.arena import Arena as Area
from comms.arena import disc, rectangle
from comms.frames import GeoPoint
from comms.transport import FORMS, transport_of


@dataclass(frozen=True, slots=True)
class Allowed:
    """Says in words what a key allows, where its type cannot."""

    text: str


Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
# What a frame on the radio and an autopilot's local frame can hold, with room to spare.
Extent = Annotated[float, Field(gt=0, le=50_000)]
Reach = Annotated[float, Field(ge=-50_000, le=50_000)]
Span = Annotated[float, Field(ge=0, le=3600)]
Charge = Annotated[float, Field(gt=0, lt=1_000_000)]
Airspeed = Annotated[float, Field(ge=0, lt=100)]
SpeedLimit = Annotated[float, Field(ge=0.1, le=100)]
Bearing = Annotated[float, Field(ge=0, lt=360)]
CORNERS = "a list of 3 to 64 corners [east, north], each number from -50000 to 50000"
NAME = "a word of letters, digits, '_', '.' and '-', at most 64 long, that starts with a letter or digit"
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.\-]{0,63}$"), Allowed(NAME)]


def _link_url(text: str) -> str:
    transport_of(text)
    return text


LINKS = f"a list with a link for each agent: {FORMS}, or null"
LinkUrl = Annotated[str, AfterValidator(_link_url)]
SYSTEM_IDS = "a list with a whole number from 1 to 250, or null, for each agent"
SystemId = Annotated[int, Field(ge=1, le=250)]


class Part(BaseModel):
    """A section of a mission: frozen, without unknown keys; a whole number may stand for a float, no more bends."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, use_attribute_docstrings=True
    )


def _tag_by(key: str, tags: Mapping[str, str]) -> Callable[[Any], str | None]:
    """Which variant of a section is meant: `tags` of the value at `key`; the first one if the key is absent."""
    default = next(iter(tags))

    def tag(section: Any) -> str | None:
        chosen = section.get(key, default) if isinstance(section, Mapping) else getattr(section, key, None)
        return tags.get(chosen) if isinstance(chosen, str) else None

    return tag


class Disc(Part):
    """A round arena, centered on home."""

    shape: Literal["disc"] = "disc"
    """The arena's shape."""
    radius_m: Extent = 30.0
    """Radius of the disc."""

    @property
    def area(self) -> Area:
        """The arena as the world and the agents know it."""
        return disc(self.radius_m)


class Rectangle(Part):
    """A rectangular arena, centered on home."""

    shape: Literal["rectangle"]
    """The arena's shape."""
    width_m: Extent = 60.0
    """Extent from west to east."""
    height_m: Extent = 60.0
    """Extent from south to north."""

    @property
    def area(self) -> Area:
        """The arena as the world and the agents know it."""
        return rectangle(self.width_m, self.height_m)


Arena = Annotated[
    Annotated[Disc, Tag("disc")] | Annotated[Rectangle, Tag("rectangle")],
    Discriminator(_tag_by("shape", {"disc": "disc", "rectangle": "rectangle"})),
]


class Home(Part):
    """Where on the globe the local origin lies (WGS84)."""

    # The local plane is a tangent plane: it has no east at the poles.
    latitude_deg: Annotated[float, Field(ge=-85, le=85)] = -35.363262
    """Degrees north of the equator."""
    longitude_deg: Annotated[float, Field(ge=-180, le=180)] = 149.165237
    """Degrees east of Greenwich."""
    altitude_m: Annotated[float, Field(ge=-500, le=9000)] = 584.0
    """Height of the ground above mean sea level."""

    @property
    def place(self) -> GeoPoint:
        """The local origin on the globe."""
        return GeoPoint(self.latitude_deg, self.longitude_deg, self.altitude_m)


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

    count: Annotated[int, Field(ge=1, le=250)] = 10
    """How many; a MAVLink system id is one byte."""
    speed_m_s: Annotated[float, Field(ge=0.1, le=50)] = 0.4
    """Greatest speed at which agents follow and search."""
    sensing: Sensing = Sensing()
    """What an agent sees."""
    deployment: AgentDeployment = AgentDeployment()
    """Where agents start."""
    altitude: Altitude = Altitude()
    """How high agents fly."""

    @property
    def sensing_ranges_m(self) -> tuple[float, ...]:
        """How far each agent sees, horizontally, by uid: r_s(v_i)."""
        sensing = self.sensing
        if sensing.field_of_view != "camera":
            return (sensing.range_m,) * self.count
        slope = tan(radians(sensing.half_angle_deg))
        return tuple(self.altitude.of_agent(uid) * slope for uid in range(self.count))


class TargetDeployment(Part):
    """Where targets start: at random places in a circle about home."""

    radius_m: Positive = 15.0
    """Radius of the circle in which targets start."""


class MovingTargets(Part):
    """Simulated targets."""

    motion: Literal["evasive", "random", "static"] = "evasive"
    """How they move: `evasive` flee from agents they notice, `random` walk and turn by chance, `static` stand still."""
    count: Annotated[int, Field(ge=1, le=1000)] = 10
    """How many."""
    speed_m_s: Positive = 0.3
    """Speed of targets that move."""
    sensing_range_m: float | None = Field(default=None, gt=0)
    """How far an evasive target notices an agent; null: as far as any agent sees."""
    deployment: TargetDeployment = TargetDeployment()
    """Where targets start."""


class TrackTargets(Part):
    """Targets that replay recorded tracks."""

    motion: Literal["tracks"]
    """How they move: along recorded tracks."""
    file: Annotated[Path, Field(strict=False), Allowed("the path of a CSV of tracks (--set targets.file=PATH)")]
    """CSV of tracks (t, id, x, y or Movebank's columns; plain or .gz); a relative path starts at the mission file."""
    start_s: NonNegative = 0.0
    """Time in the recording at which the mission starts."""
    max_gap_s: Positive = 30.0
    """A target is absent between two fixes further apart than this."""


Targets = Annotated[
    Annotated[MovingTargets, Tag("moving")] | Annotated[TrackTargets, Tag("tracks")],
    Discriminator(_tag_by("motion", {"evasive": "moving", "random": "moving", "static": "moving", "tracks": "tracks"})),
]


class Radio(Part):
    """What agents hear of each other."""

    mode: Literal["sim", "ideal"] = "sim"
    """`sim`: range, loss and latency; `ideal`: range alone."""
    range_m: Positive = 20.0
    """How far, horizontally, a frame is heard."""
    loss: Annotated[float, Field(ge=0, le=1)] = 0.0
    """Probability that a frame does not reach a receiver in range."""
    latency_s: Annotated[float, Field(ge=0, le=60)] = 0.0
    """Delay of a frame; none is heard before the next tick."""


class Policy(Part):
    """How agents decide. Keys that a policy has no use for, it leaves unread."""

    name: Literal["a-cmommt", "b-cmommt-basic", "b-cmommt", "regions"] = "b-cmommt"
    """The policy: Parker's force sum, the paper's section 4.1, its Algorithm 1, or regions after Jung & Sukhatme."""
    predictor: Literal["direct", "learned", "none", "perfect"] = "direct"
    """Foresees losses: `direct` is eq. 10 of the paper, `learned` its net for two and three tags, `none` nothing,
    `perfect` (in a study alone) what will happen if nobody helps."""
    weights: Annotated[Path | None, Field(strict=False), Allowed("null, or the path of a weights file")] = None
    """Weights of the learned predictor, written by `swarm train`; none: those that come with the package."""
    call: Literal["predicted", "all_but_nearest"] = "all_but_nearest"
    """Which of its targets an agent calls help for: those it expects to lose, or all but the nearest."""
    answer_gate: Literal["in_time", "always"] = "always"
    """Which calls are answered: those where capture comes before the loss, or all."""
    answering: Literal["distributed", "optimal"] = "distributed"
    """Who decides which call an agent answers: itself, or (in a study alone) a referee who knows all (eq. 15)."""
    capture: Literal["worst_case", "intercept"] = "intercept"
    """How the time to capture is estimated: the target flees straight away (eq. 13), or keeps its velocity."""
    help_margin_s: NonNegative = 40.0
    """A helper sets out this long before it must."""
    commitment: bool = True
    """Whether a helper stays with the call it has answered."""
    memory_s: Span = 60.0
    """How long a lost target is remembered at its predicted place."""
    explore: Literal["persistent-walk", "stale-first"] = "persistent-walk"
    """How idle agents search: a walk with a steady heading, or to the place not seen for longest."""
    standoff_m: NonNegative = 0.0
    """Distance kept to a followed target; 0: right above it."""
    turn_time_s: Span = 0.5
    """Time an agent takes to turn (delta of eq. 13)."""
    horizon_s: Annotated[float, Field(gt=0, le=3600)] = 20.0
    """Losses further ahead are not foreseen, nor in other policies the places of targets unseen for longer."""
    tag_lease_s: Positive = 0.5
    """A claim of a target expires unless renewed within this time."""
    help_lease_s: Positive = 1.0
    """Calls and answers expire unless renewed within this time."""
    follow_gain_per_s: Positive = 1.0
    """Wanted speed per meter of distance from the followed point."""


class Limits(Part):
    """What a vehicle can do."""

    speed_m_s: SpeedLimit = 10.0
    """Greatest horizontal speed."""
    acceleration_m_s2: SpeedLimit = 2.5
    """Greatest horizontal acceleration."""
    climb_m_s: SpeedLimit = 2.5
    """Greatest speed upward."""
    descent_m_s: SpeedLimit = 1.5
    """Greatest speed downward."""
    tilt_deg: Annotated[float, Field(ge=1, le=80)] = 30.0
    """Greatest lean."""


class Wind(Part):
    """The wind, the same everywhere."""

    speed_m_s: Airspeed = 0.0
    """Mean speed."""
    from_deg: Bearing = 0.0
    """Where it comes from, clockwise from north."""
    gust_m_s: Airspeed = 0.0
    """Greatest change of speed by gusts."""


class Battery(Part):
    """A vehicle's battery."""

    capacity_mah: Charge = 5000.0
    """Charge when full, in mAh."""
    voltage_v: Charge = 12.6
    """Voltage when full."""
    hover_current_a: Charge = 28.0
    """Current in hover."""


class Vehicle(Part):
    """What carries an agent: an autopilot and its airframe."""

    kind: Literal["simulated", "ideal", "link"] = "simulated"
    """`simulated`: flies as an airframe does; `ideal`: follows setpoints exactly; `link`: it flies elsewhere."""
    links: Annotated[tuple[LinkUrl | None, ...], Field(strict=False), Allowed(LINKS)] = ()
    """Where the vehicles are reached, by agent; null: that agent's is simulated. Only for kind `link`."""
    system_ids: Annotated[tuple[SystemId | None, ...], Field(strict=False), Allowed(SYSTEM_IDS)] = ()
    """The vehicles' MAVLink system ids, by agent; none or null: that of the first vehicle heard on the link."""
    boot_s: Annotated[float, Field(ge=0, le=120)] = 2.0
    """Time from power-on until the autopilot is ready to arm."""
    limits: Limits = Limits()
    """What the vehicle can do."""
    wind: Wind = Wind()
    """The wind it flies in."""
    battery: Battery = Battery()
    """What it flies on."""


class ArenaFence(Part):
    """A geofence around the arena."""

    shape: Literal["arena"] = "arena"
    """The fence's shape: the arena's, and wider."""
    margin_m: Annotated[float | None, Field(ge=0, le=10_000)] = None
    """How far beyond the arena it runs; null: as far as an agent needs to stop, and 10 m more."""


class CircleFence(Part):
    """A round geofence, centered on home."""

    shape: Literal["circle"]
    """The fence's shape."""
    radius_m: Extent = 60.0
    """Its radius."""


class PolygonFence(Part):
    """A geofence with corners."""

    shape: Literal["polygon"]
    """The fence's shape."""
    corners_m: Annotated[
        tuple[Annotated[tuple[Reach, Reach], Field(strict=False)], ...],
        Field(strict=False, min_length=3, max_length=64),
        Allowed(CORNERS),
    ]
    """Its corners in order, each meters east and north of home."""


FenceShape = Annotated[
    Annotated[ArenaFence, Tag("arena")]
    | Annotated[CircleFence, Tag("circle")]
    | Annotated[PolygonFence, Tag("polygon")],
    Discriminator(_tag_by("shape", {"arena": "arena", "circle": "circle", "polygon": "polygon"})),
]


class Safety(Part):
    """What every agent keeps to, whatever its policy wants."""

    fence: FenceShape = ArenaFence()
    """What no agent flies out of."""
    ceiling_m: Annotated[float, Field(gt=0, le=500)] = 500.0
    """No layer is higher above home."""
    separation_m: Annotated[float, Field(ge=0, le=1000)] = 2.0
    """Least horizontal distance between agents that share a layer; ideal vehicles, being points, do not keep it."""
    battery_reserve: Annotated[float, Field(ge=0, lt=1)] = 0.0
    """An agent comes home when its battery has this share left."""


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

    def link(self, uid: int) -> str | None:
        """Where agent `uid`'s vehicle is reached; None where it is simulated."""
        return self.vehicle.links[uid] if self.vehicle.links else None

    def system_id(self, uid: int) -> int | None:
        """The MAVLink system id of agent `uid`'s vehicle; None where the vehicle tells."""
        if self.link(uid) is None:
            return uid + 1
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
