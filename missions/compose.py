"""From a mission to its parts: every room's settings in that room's own words. No part runs here."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from math import atan2, cos, radians

from comms.air import Air, LinkModel
from comms.chance import PLACE_AGENT
from comms.field import FieldRadio
from comms.frames import GeoPoint, enu_from_geo, geo_from_enu
from comms.keys import Keys
from comms.radio import Radio, Roster
from comms.session import Bus
from comms.signing import Signing, read_key
from comms.transport import Transport
from missions.mission import CircleFence, Disc, Mission, PolygonFence, TrackTargets
from missions.mission.vehicle import simulated_system_id
from missions.rules import start_places
from missions.sides.medium import Medium, OpenField, SimulatedAir
from missions.targets import herd
from missions.training.weights import BUNDLED, read_weights
from missions.vehicles import LinkedVehicle, Vehicle
from swarm_agent.agent import Agent, AgentConfig
from swarm_agent.autopilot import Pilot, PilotConfig
from swarm_agent.bcmommt.net import BLANK, Net
from swarm_agent.bcmommt.params import Answering, Call, Capture, Explore, Gate, Params, Policy, Predictor, with_range
from swarm_agent.fence import Fence, circle, polygon
from swarm_agent.reserve import ReserveConfig
from swarm_agent.safety import SafetyConfig, stopping_distance_m
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.battery import Battery
from vehicle_sim.flight import FlightLimits
from vehicle_sim.placement import heading
from vehicle_sim.sensing import ALL_AROUND
from vehicle_sim.vehicle import VehicleConfig
from vehicle_sim.wind import Wind
from vehicle_sim.world import World

Place = tuple[float, float]

# Beyond the arena and the way to stop in it.
FENCE_MARGIN_M = 10.0
# A frame is worth hearing for a few ticks beyond its latency; then its sender is somewhere else.
FRAME_LIVES_TICKS = 5
_POLICIES = {
    "a-cmommt": Policy.A_CMOMMT,
    "b-cmommt-basic": Policy.B_CMOMMT_BASIC,
    "b-cmommt": Policy.B_CMOMMT,
    "regions": Policy.REGIONS,
}
_PREDICTORS = {
    "none": Predictor.NONE,
    "direct": Predictor.DIRECT,
    "learned": Predictor.LEARNED,
    "perfect": Predictor.PERFECT,
}
_CALLS = {"predicted": Call.PREDICTED, "all_but_nearest": Call.ALL_BUT_NEAREST}
_GATES = {"in_time": Gate.IN_TIME, "always": Gate.ALWAYS}
_ANSWERINGS = {"distributed": Answering.DISTRIBUTED, "optimal": Answering.OPTIMAL}
_CAPTURES = {"worst_case": Capture.WORST_CASE, "intercept": Capture.INTERCEPT}
_EXPLORES = {"persistent-walk": Explore.PERSISTENT_WALK, "stale-first": Explore.STALE_FIRST}


def deployment(mission: Mission) -> tuple[Place, ...]:
    """Where agents start, by uid: meters east and north of home, at places that MAVLink's 1e-7 degrees can tell."""
    home = mission.home.place
    return tuple(enu_from_geo(home, place)[:2] for place in pads(mission))


def headings(mission: Mission) -> tuple[Place, ...]:
    """Where agents look and search first, by uid: unit vectors east and north."""
    return tuple(heading(who=uid, seed=mission.seed, purpose=PLACE_AGENT) for uid in range(mission.agents.count))


def cos_half_opening(mission: Mission) -> float:
    """The cosine of half the angle that agents see into; ALL_AROUND unless they have a sector."""
    sensing = mission.agents.sensing
    if sensing.field_of_view != "sector" or sensing.opening_deg >= 360.0:
        return ALL_AROUND
    return cos(radians(sensing.opening_deg / 2))


def pads(mission: Mission) -> tuple[GeoPoint, ...]:
    """The same places on the globe."""
    places = start_places(mission)
    assert places is not None, "a mission whose agents do not fit is no loaded mission"
    on_globe = (geo_from_enu(mission.home.place, (x, y, 0.0)) for x, y in places)
    return tuple(
        GeoPoint(round(place.latitude_deg * 1e7) / 1e7, round(place.longitude_deg * 1e7) / 1e7, place.altitude_m)
        for place in on_globe
    )


def params(mission: Mission) -> Params:
    """The algorithm's constants; the sensing range is that of the key, and `agents` has each one's own.

    Raises:
        InputError: weights of the learned predictor that cannot be read.
    """
    policy = mission.policy
    pair_net, triple_net = _nets(mission)
    targets = mission.targets
    # Nobody knows how fast recorded animals can be; as fast as an agent is the worst case that can still be followed.
    target_speed = mission.agents.speed_m_s if isinstance(targets, TrackTargets) else targets.speed_m_s
    return Params(
        arena=mission.arena.area,
        tick_s=mission.tick_s,
        sensing_range_m=mission.agents.sensing.range_m,
        agent_speed_m_s=mission.agents.speed_m_s,
        target_speed_m_s=target_speed,
        standoff_m=mission.standoff_m,
        turn_time_s=policy.turn_time_s,
        horizon_s=policy.horizon_s,
        help_margin_s=policy.help_margin_s,
        tag_lease_s=policy.tag_lease_s,
        help_lease_s=policy.help_lease_s,
        memory_s=policy.memory_s,
        follow_gain_per_s=policy.follow_gain_per_s,
        predictor=_PREDICTORS[policy.predictor],
        call=_CALLS[policy.call],
        gate=_GATES[policy.answer_gate],
        capture=_CAPTURES[policy.capture],
        commitment=policy.commitment,
        explore=_EXPLORES[policy.explore],
        answering=_ANSWERINGS[policy.answering],
        policy=_POLICIES[policy.name],
        pair_net=pair_net,
        triple_net=triple_net,
    )


def _nets(mission: Mission) -> tuple[Net, Net]:
    """The learned predictor's nets, for two tags and for three."""
    if mission.policy.predictor != "learned":
        return BLANK, BLANK
    weights = read_weights(mission.policy.weights or BUNDLED)
    return weights.pair.net, weights.triple.net


def agents(mission: Mission, uids: Iterable[int], n_targets: int) -> list[Agent]:
    """These agents of a mission."""
    shared, around = params(mission), fence(mission)
    firsts = headings(mission)
    return [
        Agent(
            AgentConfig(
                uid=uid,
                seed=mission.seed,
                params=with_range(shared, mission.agents.sensing_ranges_m[uid]),
                n_agents=mission.agents.count,
                n_targets=n_targets,
                heading=firsts[uid],
                ttl_s=ttl_s(mission),
                radio_range_m=mission.radio.range_m,
                pilot=PilotConfig(
                    uid=uid,
                    system_id=mission.system_id(uid),
                    home=mission.home.place,
                    altitude_m=mission.agents.altitude.of_agent(uid),
                    max_speed_m_s=mission.agents.speed_m_s,
                    max_climb_m_s=min(mission.vehicle.limits.climb_m_s, mission.vehicle.limits.descent_m_s, 10.0),
                ),
                safety=SafetyConfig(
                    uid=uid,
                    fence=around,
                    # Ideal vehicles are points, which cannot collide: their missions are those of a study.
                    separation_m=0.0 if mission.vehicle.kind == "ideal" else mission.safety.separation_m,
                    max_speed_m_s=mission.agents.speed_m_s,
                    acceleration_m_s2=mission.vehicle.limits.acceleration_m_s2,
                ),
                reserve=reserve(mission, uid),
            ),
            signing=signing(mission, uid),
        )
        for uid in uids
    ]


def reserve(mission: Mission, uid: int) -> ReserveConfig:
    """What must be left in the battery of agent `uid`'s vehicle for its way home."""
    share, battery = mission.safety.battery_reserve, Battery(**mission.vehicle.battery.model_dump())
    # A vehicle elsewhere has a battery of its own, of which the mission knows nothing.
    voltage_v = battery.voltage_in_hover(share) if mission.link(uid) is None and share > 0.0 else None
    # An ideal one does not tire, for its missions are those of a study; but its battery may break.
    return ReserveConfig(share=None if mission.vehicle.kind == "ideal" else share, voltage_v=voltage_v)


def signing(mission: Mission, uid: int) -> Signing | None:
    """How the link to agent `uid`'s vehicle is signed; None if it is not, or not there."""
    file = mission.vehicle.signing_key
    return None if file is None or mission.link(uid) is None else Signing(read_key(file), unix_time=time.time)


def fence(mission: Mission) -> Fence:
    """What no agent may leave, as the agents know it."""
    given, arena = mission.safety.fence, mission.arena
    if isinstance(given, PolygonFence):
        return polygon(given.corners_m)
    if isinstance(given, CircleFence):
        return circle(given.radius_m)
    margin_m = given.margin_m
    if margin_m is None:
        margin_m = FENCE_MARGIN_M + stopping_distance_m(
            mission.agents.speed_m_s, mission.vehicle.limits.acceleration_m_s2
        )
    if isinstance(arena, Disc):
        return circle(arena.radius_m + margin_m)
    east, north = arena.width_m / 2 + margin_m, arena.height_m / 2 + margin_m
    return polygon([(east, north), (-east, north), (-east, -north), (east, -north)])


def vehicles(
    mission: Mission, pilots: Iterable[Pilot], transports: Mapping[int, Transport], *, started_at_s: float = 0.0
) -> list[Vehicle]:
    """These pilots' vehicles: behind their open transports, by uid, or simulated.

    A simulated one stands at its own home and is switched on at that time.
    """
    vehicle, places, homes, firsts = mission.vehicle, deployment(mission), pads(mission), headings(mission)
    config = VehicleConfig(
        kind="ideal" if vehicle.kind == "ideal" else "simulated",
        flavor=vehicle.flavor,
        boot_s=vehicle.boot_s,
        limits=FlightLimits(**vehicle.limits.model_dump()),
        wind=Wind(**vehicle.wind.model_dump()),
        battery=Battery(**vehicle.battery.model_dump()),
    )
    parts: list[Vehicle] = []
    for pilot in pilots:
        uid = pilot.config.uid
        if uid in transports:
            parts.append(LinkedVehicle(transports[uid], pilot=pilot, pad_m=(*places[uid], 0.0)))
            continue
        east, north = firsts[uid]
        parts.append(
            SimulatedVehicle(
                config=config,
                system_id=simulated_system_id(uid),
                home=homes[uid],
                heading_rad=atan2(east, north),
                seed=mission.seed,
                started_at_s=started_at_s,
            )
        )
    return parts


def world(mission: Mission) -> World:
    """The targets, and what sensors see of them.

    Raises:
        InputError: a file of tracks that cannot be read, or of another place.
    """
    return World(
        herd=herd(mission),
        sensing_ranges_m=mission.agents.sensing_ranges_m,
        headings=headings(mission),
        cos_half_opening=cos_half_opening(mission),
        identity_error=mission.agents.sensing.identity_error,
        seed=mission.seed,
    )


def radios(mission: Mission, bus: Bus, uids: Iterable[int], n_targets: int) -> list[Radio]:
    """The radios of these agents."""
    roster = Roster(mission.agents.count, n_targets)
    kind, keys = FieldRadio if mission.radio.mode == "field" else Radio, Keys(mission.name)
    return [kind(bus, keys=keys, uid=uid, roster=roster, ttl_s=ttl_s(mission)) for uid in uids]


def ttl_s(mission: Mission) -> float:
    """How long a frame is worth hearing after it was sent."""
    return mission.radio.latency_s + FRAME_LIVES_TICKS * mission.tick_s


def medium(mission: Mission, bus: Bus) -> Medium:
    """What carries the agents' frames."""
    if mission.radio.mode == "field":
        return OpenField(mission.agents.count)
    return SimulatedAir(air(mission, bus))


def air(mission: Mission, bus: Bus) -> Air:
    """The simulated medium between the agents."""
    radio = mission.radio
    return Air(
        bus,
        keys=Keys(mission.name),
        model=LinkModel(range_m=radio.range_m, loss=radio.loss, latency_s=radio.latency_s),
        n_agents=mission.agents.count,
        tick_s=mission.tick_s,
        seed=mission.seed,
    )
