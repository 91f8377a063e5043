"""Rules between the keys of a mission: each names the key it blames, the keys it compares with, and what is allowed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from itertools import groupby

from comms.arena import edge_distance_m
from comms.chance import PLACE_AGENT
from comms.signing import KeyFileError, read_key
from missions.mission import MOST_SYSTEMS, CircleFence, Mission, MovingTargets, PolygonFence, TrackTargets
from missions.problems import InputError, Path, shown
from missions.training.weights import read_weights
from swarm_agent.fence import encloses
from vehicle_sim.placement import scatter

_TOLERANCE = 1e-9
SLOWEST_SETPOINTS_S = 0.4
MOST_CELLS = 20_000  # of the arena, each as wide as the sensing range; every agent remembers when it was seen


@dataclass(frozen=True, slots=True)
class Rule:
    """`allowed(mission)` is None where the rule holds, and otherwise what it allows at `key`, in words."""

    key: str
    others: tuple[str, ...]
    allowed: Callable[[Mission], str | None]

    @property
    def paths(self) -> tuple[Path, ...]:
        """Every key the rule looks at, the blamed one first."""
        return tuple(tuple(key.split(".")) for key in (self.key, *self.others))


def start_places(mission: Mission) -> tuple[tuple[float, float], ...] | None:
    """Where agents start, by uid: meters east and north of home; None if the mission's chance finds no room for all."""
    deployment = mission.agents.deployment
    try:
        return scatter(
            count=mission.agents.count,
            radius_m=deployment.radius_m,
            spacing_m=deployment.spacing_m,
            seed=mission.seed,
            purpose=PLACE_AGENT,
        )
    except ValueError:
        return None


def _mission_has_ticks(mission: Mission) -> str | None:
    if mission.duration_s >= mission.tick_s:
        return None
    return f"at least one tick_s ({shown(mission.tick_s)})"


def _agents_outrun_targets(mission: Mission) -> str | None:
    targets = mission.targets
    if not isinstance(targets, MovingTargets) or targets.motion == "static":
        return None
    if mission.agents.speed_m_s > targets.speed_m_s:
        return None
    return f"more than targets.speed_m_s ({shown(targets.speed_m_s)}) of {targets.motion} targets"


def _agents_start_inside(mission: Mission) -> str | None:
    return _inside(mission, mission.agents.deployment.radius_m)


def _targets_start_inside(mission: Mission) -> str | None:
    targets = mission.targets
    return _inside(mission, targets.deployment.radius_m) if isinstance(targets, MovingTargets) else None


def _inside(mission: Mission, radius_m: float) -> str | None:
    inner_m = edge_distance_m(mission.arena.area, 0.0, 0.0)
    if radius_m <= inner_m:
        return None
    return f"at most {shown(inner_m)}, the largest circle inside the arena"


def _agents_fit(mission: Mission) -> str | None:
    agents = mission.agents
    if start_places(mission) is not None:
        return None
    return f"less, to fit {agents.count} agents into agents.deployment.radius_m ({shown(agents.deployment.radius_m)})"


def _mates_hear_beyond_sight(mission: Mission) -> str | None:
    farthest_m = max(mission.agents.sensing_ranges_m)
    return None if mission.radio.range_m > farthest_m else f"more than {_range_words(mission, farthest_m)}"


def _loss_is_simulated(mission: Mission) -> str | None:
    radio = mission.radio
    return None if radio.mode == "sim" or radio.loss == 0 else f"0 where radio.mode is {radio.mode}"


def _ideal_radio_is_prompt(mission: Mission) -> str | None:
    return None if mission.radio.mode != "ideal" or mission.radio.latency_s == 0 else "0 where radio.mode is ideal"


def _endpoints_are_of_radios(mission: Mission) -> str | None:
    endpoints, count = mission.radio.endpoints, mission.agents.count
    if not endpoints:
        return None
    if mission.radio.mode != "field":
        return "none where radio.mode is not field"
    if len(endpoints) != count:
        return f"as many as agents.count ({count}); these are {len(endpoints)}"
    parts = [endpoint for endpoint, _ in groupby(endpoints)]
    twice = [endpoint for endpoint, times in Counter(parts).items() if times > 1]
    return f"one endpoint for agents with numbers in a row; {twice[0]} comes again" if twice else None


def _standoff_in_sight(mission: Mission) -> str | None:
    nearest_m = min(mission.agents.sensing_ranges_m)
    return None if mission.standoff_m < nearest_m else f"less than {_range_words(mission, nearest_m)}"


def _range_words(mission: Mission, range_m: float) -> str:
    """Where a sensing range comes from."""
    if mission.agents.sensing.field_of_view == "camera":
        return f"a camera with agents.sensing.half_angle_deg sees ({shown(round(range_m, 3))})"
    return f"agents.sensing.range_m ({shown(range_m)})"


def _tag_lease_is_renewable(mission: Mission) -> str | None:
    return _renewable(mission, mission.policy.tag_lease_s)


def _help_lease_is_renewable(mission: Mission) -> str | None:
    return _renewable(mission, mission.policy.help_lease_s)


def _renewable(mission: Mission, lease_s: float) -> str | None:
    least_s = 2 * mission.tick_s + mission.radio.latency_s
    if lease_s >= least_s - _TOLERANCE:
        return None
    return f"at least two tick_s and radio.latency_s ({shown(least_s)}), or it ends before it is renewed"


def _vehicles_keep_up(mission: Mission) -> str | None:
    if mission.vehicle.limits.speed_m_s >= mission.agents.speed_m_s:
        return None
    return f"at least agents.speed_m_s ({shown(mission.agents.speed_m_s)})"


def _links_are_for_agents(mission: Mission) -> str | None:
    links, count = mission.vehicle.links, mission.agents.count
    if mission.vehicle.kind != "link":
        return "none where vehicle.kind is not link" if links else None
    if len(links) != count:
        return f"as many as agents.count ({count}); these are {len(links)}"
    twice = [link for link, times in Counter(filter(None, links)).items() if times > 1]
    return f"each link once; {twice[0]} is there twice" if twice else None


def _setpoints_come_often(mission: Mission) -> str | None:
    vehicle = mission.vehicle
    if (vehicle.kind != "link" and vehicle.flavor != "px4") or mission.tick_s <= SLOWEST_SETPOINTS_S:
        return None
    where = "vehicle.kind is link" if vehicle.kind == "link" else "vehicle.flavor is px4"
    return f"at most {shown(SLOWEST_SETPOINTS_S)} where {where}: a PX4 wants setpoints at more than 2 Hz"


def _systems_have_ids(mission: Mission) -> str | None:
    kind = mission.vehicle.kind
    if kind == "ideal" or mission.agents.count <= MOST_SYSTEMS:
        return None
    return (
        f"at most {MOST_SYSTEMS} where vehicle.kind is {kind} (a MAVLink system id is one byte), or vehicle.kind ideal"
    )


def _system_ids_are_for_links(mission: Mission) -> str | None:
    given = len(mission.vehicle.system_ids)
    if given in (0, len(mission.vehicle.links)):
        return None
    return f"none, or as many as vehicle.links ({len(mission.vehicle.links)}); these are {given}"


def _signing_key_is_readable(mission: Mission) -> str | None:
    file = mission.vehicle.signing_key
    if file is None:
        return None
    if not any(mission.vehicle.links):
        return "null where no vehicle is behind a link"
    try:
        read_key(file)
    except KeyFileError as error:
        return str(error).partition("allowed: ")[2]
    return None


def _vehicles_beat_the_wind(mission: Mission) -> str | None:
    wind, most_m_s = mission.vehicle.wind, mission.vehicle.limits.speed_m_s
    if wind.speed_m_s + wind.gust_m_s < most_m_s:
        return None
    return (
        f"with vehicle.wind.gust_m_s ({shown(wind.gust_m_s)}), less than vehicle.limits.speed_m_s ({shown(most_m_s)})"
    )


def _tracks_exist(mission: Mission) -> str | None:
    targets = mission.targets
    return "a file that exists" if isinstance(targets, TrackTargets) and not targets.file.is_file() else None


def _weights_are_readable(mission: Mission) -> str | None:
    file = mission.policy.weights
    if file is None:
        return None
    try:
        read_weights(file)
    except InputError as error:
        return f"null, or a weights file of swarm train ({error.__cause__})"
    return None


def _layers_are_low(mission: Mission) -> str | None:
    altitude = mission.agents.altitude
    top_m = max(altitude.of_agent(uid) for uid in range(mission.agents.count))
    ceiling_m = mission.safety.ceiling_m
    return None if top_m <= ceiling_m else f"less: the highest layer is at {shown(top_m)}, above {shown(ceiling_m)}"


def _circle_fences_the_start(mission: Mission) -> str | None:
    fence, radius_m = mission.safety.fence, mission.agents.deployment.radius_m
    if not isinstance(fence, CircleFence) or fence.radius_m > radius_m:
        return None
    return f"more than agents.deployment.radius_m ({shown(radius_m)})"


def _corners_fence_the_start(mission: Mission) -> str | None:
    fence = mission.safety.fence
    if not isinstance(fence, PolygonFence):
        return None
    places = start_places(mission) or ()
    outside = [uid for uid, (x, y) in enumerate(places) if not encloses(fence.corners_m, x, y)]
    return f"corners around every starting place (agent {outside[0]} starts outside)" if outside else None


def _search_has_few_cells(mission: Mission) -> str | None:
    area, side_m = mission.arena.area, min(mission.agents.sensing_ranges_m)
    few = 4 * area.half_x_m * area.half_y_m <= MOST_CELLS * side_m * side_m
    if few or mission.policy.explore != "stale-first":
        return None
    return "persistent-walk in an arena that is so large beside agents.sensing.range_m"


def _predictor_flies(mission: Mission) -> str | None:
    if mission.policy.predictor != "perfect":
        return None
    return "direct, learned or none (perfect is for swarm study alone)"


def _answering_flies(mission: Mission) -> str | None:
    return None if mission.policy.answering == "distributed" else "distributed (optimal is for swarm study alone)"


def _radio_is_simulated(mission: Mission) -> str | None:
    return None if mission.radio.mode != "field" else "sim or ideal (field is for flights)"


_SENSING = tuple(f"agents.sensing.{key}" for key in ("range_m", "field_of_view", "half_angle_deg"))
_START = ("agents.deployment.radius_m", "agents.deployment.spacing_m", "agents.count", "seed")
_ARENA = ("arena", "arena.radius_m", "arena.width_m", "arena.height_m")

RULES = (
    Rule("duration_s", ("tick_s",), _mission_has_ticks),
    Rule("agents.speed_m_s", ("targets.speed_m_s", "targets.motion"), _agents_outrun_targets),
    Rule("agents.deployment.radius_m", _ARENA, _agents_start_inside),
    Rule("targets.deployment.radius_m", _ARENA, _targets_start_inside),
    Rule("agents.deployment.spacing_m", ("agents.deployment.radius_m", "agents.count", "seed"), _agents_fit),
    Rule("agents.altitude.layer_m", ("agents.altitude.base_m", "agents.count", "safety.ceiling_m"), _layers_are_low),
    Rule("safety.fence.radius_m", ("agents.deployment.radius_m",), _circle_fences_the_start),
    Rule("safety.fence.corners_m", _START, _corners_fence_the_start),
    Rule("policy.explore", (*_SENSING, *_ARENA), _search_has_few_cells),
    Rule("radio.range_m", _SENSING, _mates_hear_beyond_sight),
    Rule("radio.loss", ("radio.mode",), _loss_is_simulated),
    Rule("radio.latency_s", ("radio.mode",), _ideal_radio_is_prompt),
    Rule("radio.endpoints", ("radio.mode", "agents.count"), _endpoints_are_of_radios),
    Rule("policy.standoff_m", _SENSING, _standoff_in_sight),
    Rule("policy.tag_lease_s", ("tick_s", "radio.latency_s"), _tag_lease_is_renewable),
    Rule("policy.help_lease_s", ("tick_s", "radio.latency_s"), _help_lease_is_renewable),
    Rule("vehicle.limits.speed_m_s", ("agents.speed_m_s",), _vehicles_keep_up),
    Rule("vehicle.links", ("vehicle.kind", "agents.count"), _links_are_for_agents),
    Rule("tick_s", ("vehicle.kind", "vehicle.flavor"), _setpoints_come_often),
    Rule("vehicle.system_ids", ("vehicle.links",), _system_ids_are_for_links),
    Rule("vehicle.signing_key", ("vehicle.links",), _signing_key_is_readable),
    Rule("vehicle.wind.speed_m_s", ("vehicle.wind.gust_m_s", "vehicle.limits.speed_m_s"), _vehicles_beat_the_wind),
    Rule("targets.file", (), _tracks_exist),
    Rule("policy.weights", (), _weights_are_readable),
)
FLIGHT_RULES = (
    Rule("agents.count", ("vehicle.kind",), _systems_have_ids),
    Rule("policy.predictor", (), _predictor_flies),
    Rule("policy.answering", (), _answering_flies),
)
"""What holds beside them where a mission is flown, and not in a study."""
STUDY_RULES = (Rule("radio.mode", (), _radio_is_simulated),)
"""What holds beside them in a study."""
