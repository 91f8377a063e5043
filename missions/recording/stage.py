"""What is drawn once: the ground under everything, names, sizes, line styles, and the recording's properties."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import rerun as rr

from comms.frames import geo_from_enu
from comms.status import Activity
from missions.recording import hazards, palette, shapes
from missions.recording.columns import on_ground
from missions.recording.scene import Scene
from missions.recording.tape import Tape

# Words short enough for a lane of a few seconds.
_LANE_WORDS: dict[Activity, str] = {
    Activity.PREPARING: "prepare",
    Activity.TAKEN_OVER: "taken",
    Activity.EXPLORE: "explore",
    Activity.FOLLOW: "follow",
    Activity.CALLING: "calls",
    Activity.HELPING: "helps",
    Activity.RETURNING: "return",
    Activity.LANDED: "landed",
    Activity.LOST: "LOST",
}

# Beyond so many, names hide more than they tell; they still show when pointed at.
_NAMED_TARGETS, _NAMED_AGENTS = 20, 40
# Of an agent in the radio graph, in the graph's own units, where it has no name.
_NODE_RADIUS = 2.0


@dataclass(frozen=True, slots=True)
class Sizes:
    """Glyph sizes that look the same in a 30 m disc and in a 1.5 km square, meters."""

    unit_m: float

    @classmethod
    def of(cls, scene: Scene) -> Sizes:
        """The sizes for this scene's arena."""
        return cls(scene.size_m / 100)

    @property
    def arrow_m(self) -> float:
        """The arrow that shows an agent's heading, tail to tip."""
        return 5.0 * self.unit_m

    @property
    def tag_radius_m(self) -> float:
        """The ring around a target."""
        return 1.7 * self.unit_m

    @property
    def call_radius_m(self) -> float:
        """The ring around a target that help is called for."""
        return 2.8 * self.unit_m


def set_stage(tape: Tape, scene: Scene) -> None:
    """Record everything static; what nothing can be read without stands in two places of the file, for bad disks."""
    _set_properties(tape, scene)
    tape.flush()
    tape.log_static("/world", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
    _set_ground(tape, scene)
    _set_agents(tape, scene)
    _set_targets(tape, scene)
    _set_lines(tape, scene)
    _set_minds(tape, scene)
    _set_charts(tape, scene)
    _set_map(tape, scene)
    _set_properties(tape, scene)


def _on_screen(points: float) -> list[float]:
    """A radius in points of the screen, whatever the distance: rerun writes it as a negative number."""
    return [-points]


def _set_ground(tape: Tape, scene: Scene) -> None:
    unit = Sizes.of(scene).unit_m
    vertices, triangles = shapes.ground_mesh(scene.arena)
    height = np.full((len(vertices), 1), -0.02 * unit, dtype=np.float32)
    mesh = rr.Mesh3D(
        vertex_positions=np.hstack((vertices, height)),
        triangle_indices=triangles,
        albedo_factor=(1.0, 1.0, 1.0, palette.GROUND_SHARE),
    )
    tape.log_static("/world/seen", mesh)
    edge = shapes.edge_line(scene.arena)
    tape.log_static(
        "/world/arena/edge",
        rr.LineStrips3D([on_ground(edge)], colors=[palette.EDGE], radii=_on_screen(1.6)),
    )
    grid = shapes.grid_lines(scene.arena)
    tape.log_static(
        "/world/arena/grid",
        rr.LineStrips3D(on_ground(grid), colors=[palette.GRID], radii=_on_screen(0.4)),
    )


def _set_agents(tape: Tape, scene: Scene) -> None:
    sizes, named = Sizes.of(scene), scene.n_agents <= _NAMED_AGENTS
    tape.log_static(
        "/world/agents/body",
        rr.Points3D.from_fields(labels=scene.agent_names, show_labels=named, radii=_on_screen(3.0)),
    )
    tape.log_static("/radio/graph", rr.GraphNodes.from_fields(show_labels=named, radii=[_NODE_RADIUS]))
    tape.log_static("/world/agents/heading", rr.Arrows3D.from_fields(radii=[sizes.arrow_m / 6.5]))
    tape.log_static("/world/agents/stem", rr.LineStrips3D.from_fields(radii=_on_screen(0.6)))
    tape.log_static("/world/agents/trail", rr.LineStrips3D.from_fields(radii=_on_screen(1.2)))
    if scene.sees_all_around:
        tape.log_static(
            "/world/agents/sensing", _ring(sizes, rr.components.FillMode.TransparentFillMajorWireframe, 1.1)
        )
    else:
        tape.log_static("/world/agents/sensing", rr.LineStrips3D.from_fields(radii=_on_screen(1.1)))


def _ring(sizes: Sizes, fill: rr.components.FillMode, width: float) -> rr.Cylinders3D:
    """What flat rings on the ground have in common."""
    return rr.Cylinders3D.from_fields(lengths=[0.002 * sizes.unit_m], line_radii=_on_screen(width), fill_mode=fill)


def _set_targets(tape: Tape, scene: Scene) -> None:
    sizes = Sizes.of(scene)
    named = scene.n_targets <= _NAMED_TARGETS
    tape.log_static(
        "/world/targets/body",
        rr.Points3D.from_fields(radii=_on_screen(4.0), show_labels=named),
    )
    for path, width in (("tags", 1.8), ("calls", 1.4)):
        tape.log_static(f"/world/targets/{path}", _ring(sizes, rr.components.FillMode.MajorWireframe, width))


def _set_lines(tape: Tape, scene: Scene) -> None:
    tape.log_static("/world/tracks", rr.LineStrips3D.from_fields(radii=_on_screen(0.8)))
    tape.log_static("/world/links", rr.LineStrips3D.from_fields(radii=_on_screen(0.5), colors=[palette.LINK]))
    tape.log_static("/world/broken", rr.LineStrips3D.from_fields(radii=_on_screen(0.9), colors=[palette.BROKEN]))
    tape.log_static(
        "/world/help", rr.Arrows3D.from_fields(radii=_on_screen(2.0), show_labels=scene.n_agents <= _NAMED_AGENTS)
    )


def _set_minds(tape: Tape, scene: Scene) -> None:
    for path, radius in (("/truth/agents", 1.5), ("/truth/targets", 2.5)):
        tape.log_static(path, rr.Points3D.from_fields(colors=[palette.TRUE], radii=_on_screen(radius)))
    sight = _ring(Sizes.of(scene), rr.components.FillMode.MajorWireframe, 1.1)
    for name in scene.agent_names:
        tape.log_static(
            f"/knowledge/{name}",
            sight,
            rr.Points3D.from_fields(radii=_on_screen(4.0), show_labels=True),
            rr.LineStrips3D.from_fields(radii=_on_screen(1.1)),
            rr.TextDocument.from_fields(media_type=rr.MediaType.MARKDOWN),
        )


def _set_charts(tape: Tape, scene: Scene) -> None:
    lanes = rr.StateConfiguration(
        values=[activity.value for activity in _LANE_WORDS],
        labels=list(_LANE_WORDS.values()),
        colors=np.array([palette.ACTIVITY_COLORS[activity] for activity in _LANE_WORDS], dtype=np.uint32),
    )
    for name in scene.agent_names:
        tape.log_static(f"/agents/{name}/mode", lanes)
    if scene.faults:
        tape.log_static(hazards.LANE, _hazards(scene))
    for path, style in _chart_styles(scene).items():
        names, colors, widths = zip(*style, strict=True)
        tape.log_static(path, rr.SeriesLines(names=names, colors=np.array(colors, dtype=np.uint32), widths=widths))


def _hazards(scene: Scene) -> rr.StateConfiguration:
    states = hazards.states_of(scene.faults)
    colors = np.full(len(states), palette.WRONG, dtype=np.uint32)
    return rr.StateConfiguration(
        values=states, labels=states, colors=colors, visible=[state != hazards.NONE for state in states]
    )


def _chart_styles(scene: Scene) -> dict[str, list[tuple[str, int, float]]]:
    """For each plotted vector: name, color and line width of its elements, in their order."""
    agents = [
        (name, color, 1.2) for name, color in zip(scene.agent_names, palette.series_colors(scene.n_agents), strict=True)
    ]
    return {
        "/metrics/coverage": [
            ("seen now", palette.COVERAGE_NOW, 1.0),
            ("mean so far", palette.COVERAGE_MEAN, 2.2),
        ],
        "/metrics/floor": [("random, standing still", palette.COVERAGE_FLOOR, 1.0)],
        "/metrics/utilization": [("mean so far", palette.UTILIZATION, 1.6)],
        "/metrics/net": [
            ("sent", palette.RADIO_SENT, 1.4),
            ("delivered", palette.RADIO_DELIVERED, 1.4),
            ("lost", palette.RADIO_LOST, 1.4),
            ("out of range", palette.RADIO_OUT_OF_RANGE, 1.0),
        ],
        "/telemetry/battery": agents,
        "/telemetry/altitude": agents,
        "/telemetry/speed": agents,
        "/telemetry/tick_late": [("tick late", palette.TICK_LATE, 1.4)],
    }


def _set_map(tape: Tape, scene: Scene) -> None:
    places = [geo_from_enu(scene.home, (float(x), float(y), 0.0)) for x, y in shapes.edge_line(scene.arena)]
    line = [(place.latitude_deg, place.longitude_deg) for place in places]
    tape.log_static(
        "/geo/arena",
        rr.GeoLineStrings(lat_lon=[line], colors=[palette.EDGE], radii=_on_screen(1.5)),
    )
    tape.log_static("/geo/agents", rr.GeoPoints.from_fields(radii=_on_screen(5.0)))
    tape.log_static("/geo/trail", rr.GeoLineStrings.from_fields(radii=_on_screen(1.4)))
    tape.log_static("/geo/sight", rr.GeoLineStrings.from_fields(radii=_on_screen(1.0)))
    tape.log_static("/geo/targets", rr.GeoPoints.from_fields(radii=_on_screen(3.0)))


def _set_properties(tape: Tape, scene: Scene) -> None:
    tape.set_property(
        "mission",
        rr.AnyValues(
            name=scene.mission_name,
            policy=scene.policy,
            seed=scene.seed,
            agents=scene.n_agents,
            targets=scene.n_targets,
            tick_s=scene.tick_s,
            coverage_floor=scene.coverage_floor,
            yaml=scene.mission_yaml,
        ),
    )
    if scene.versions:
        tape.set_property("versions", rr.AnyValues(drop_untyped_nones=True, **scene.versions))
    tape.log_static("/mission", rr.TextDocument(_about(scene), media_type=rr.MediaType.MARKDOWN))


def _about(scene: Scene) -> str:
    facts = {"policy": scene.policy, "seed": str(scene.seed), **scene.versions}
    if scene.flown_at:
        facts = {"flown at": scene.flown_at, **facts}
    table = "\n".join(f"| {name} | `{value}` |" for name, value in facts.items())
    yaml = scene.mission_yaml.rstrip()
    return f"# {scene.mission_name}\n\n| setting | value |\n|---|---|\n{table}\n\n```yaml\n{yaml}\n```\n"
