"""How the viewer shows a recording at first: four tabs, stored in the file."""

from __future__ import annotations

from typing import Any

import rerun as rr
import rerun.blueprint as rrb

from missions.recording import hazards
from missions.recording.event_view import event_log
from missions.recording.eye import fitting_eye
from missions.recording.minds_view import in_tens, knowledge
from missions.recording.places import GRAPH_SIZE
from missions.recording.scene import Scene
from missions.recording.tape import TICK_LINE, TIME_LINE

_TRAIL_S, _MAP_TRAIL_S = 20.0, 60.0
# Who hears whom in a larger swarm hides everything else in space; the graph still shows it, and an eye in the list.
_LINKED_AGENTS = 40
_LEGEND_AGENTS = 10


def blueprint(scene: Scene, *, live: bool) -> rrb.Blueprint:
    """Tabs, from the mission to the raw numbers. A live viewer follows the newest tick; a review starts paused."""
    play_state = rrb.components.PlayState.Following if live else rrb.components.PlayState.Paused
    return rrb.Blueprint(
        rrb.Tabs(_mission(scene), knowledge(scene), _telemetry(scene), _map(), _raw(scene), active_tab=0),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(state="collapsed", timeline=TIME_LINE, play_state=play_state),
        auto_layout=False,
        auto_views=False,
    )


def _mission(scene: Scene) -> rrb.Container:
    return rrb.Horizontal(
        rrb.Vertical(
            _swarm(scene),
            rrb.Horizontal(_coverage(), _radio(scene), column_shares=[5, 3]),
            row_shares=[5, 2],
        ),
        _story(scene),
        column_shares=[3, 2],
        name="Mission",
    )


def _swarm(scene: Scene) -> rrb.View:
    position, target = fitting_eye(scene)
    return rrb.Spatial3DView(
        origin="/world",
        name="Swarm",
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital,
            position=position,
            look_target=target,
            eye_up=(0.0, 0.0, 1.0),
        ),
        overrides={
            "/world/agents/trail": [rrb.VisibleTimeRanges(_lately(_TRAIL_S)), rr.LineStrips3D.from_fields()],
            "/world/links": [
                rrb.EntityBehavior(visible=scene.n_agents <= _LINKED_AGENTS),
                rr.LineStrips3D.from_fields(),
            ],
        },
    )


def whole_time() -> rrb.TimeAxis:
    """All of the recording, and not what is near the cursor."""
    boundary = rrb.TimeRangeBoundary
    return rrb.TimeAxis(view_range=rrb.TimeRange(start=boundary.infinite(), end=boundary.infinite()))


def _lately(seconds: float) -> list[rrb.VisibleTimeRange]:
    boundary = rrb.TimeRangeBoundary
    start = boundary.cursor_relative(seconds=-seconds)
    return [rrb.VisibleTimeRange(TIME_LINE, start=start, end=boundary.cursor_relative())]


def _coverage() -> rrb.View:
    return rrb.TimeSeriesView(
        origin="/metrics",
        contents=["/metrics/coverage", "/metrics/floor"],
        name="Coverage",
        axis_x=whole_time(),
        axis_y=rrb.ScalarAxis(range=(0.0, 1.02), zoom_lock=True),
        plot_legend=rrb.PlotLegend(rrb.Corner2D.RightBottom),
    )


def _radio(scene: Scene) -> rrb.View:
    halves = scene.arena.half_x_m, scene.arena.half_y_m
    reach_x, reach_y = (0.56 * GRAPH_SIZE * half / max(halves) for half in halves)
    return rrb.GraphView(
        origin="/radio/graph",
        name="Who hears whom",
        visual_bounds=rrb.VisualBounds2D(x_range=(-reach_x, reach_x), y_range=(-reach_y, reach_y)),
    )


def _story(scene: Scene) -> rrb.Container:
    """What happens, in lanes and in words; and what is wrong, above it, where a mission has faults of its own."""
    lanes = rrb.StateTimelineView(origin="/agents", contents="/agents/**", name="What each agent does")
    views, shares = [lanes, event_log("/log", name="Events")], [5.0, 3.0]
    if scene.faults:
        wrong = rrb.StateTimelineView(origin=hazards.LANE, name="Faults in force", time_view=whole_time())
        views, shares = [wrong, *views], [1.3, *shares]
    return rrb.Vertical(*views, row_shares=shares)


def _telemetry(scene: Scene) -> rrb.Container:
    # A legend of many agents covers their lines, which tell their names when pointed at.
    named = rrb.PlotLegend(rrb.Corner2D.LeftTop, visible=scene.n_agents <= _LEGEND_AGENTS)
    views = [
        rrb.TimeSeriesView(origin=path, name=name, axis_x=whole_time(), plot_legend=legend)
        for path, name, legend in (
            ("/telemetry/altitude", "Altitude, m", named),
            ("/telemetry/speed", "Speed, m/s", named),
            ("/telemetry/battery", "Battery, share left", named),
            ("/telemetry/tick_late", "Tick lateness, s", None),
            ("/metrics/utilization", "Utilization, targets seen per agent", None),
            ("/metrics/net", "Radio, frames a second", None),
        )
    ]
    return rrb.Grid(*views, grid_columns=2, name="Telemetry")


def _map() -> rrb.View:
    lately = rrb.VisibleTimeRanges(_lately(_MAP_TRAIL_S))
    return rrb.MapView(origin="/geo", name="Map", overrides={"/geo/trail": [lately, rr.GeoLineStrings.from_fields()]})


def _numbers(path: str) -> rrb.components.ComponentColumnSelector:
    return rrb.components.ComponentColumnSelector(entity_path=path, component="Scalars:scalars")


def _raw(scene: Scene) -> rrb.Container:
    vectors = ("metrics/coverage", "metrics/utilization", "metrics/net", "telemetry/altitude", "telemetry/speed")
    select: list[Any] = [TICK_LINE, TIME_LINE, *(_numbers(f"/{path}") for path in vectors)]
    query = rrb.archetypes.DataframeQuery(timeline=TICK_LINE, select=select)
    numbers = rrb.DataframeView(origin="/", contents=["/metrics/**", "/telemetry/**"], name="Numbers", query=query)
    mission = rrb.TextDocumentView(origin="/mission", name="The mission")
    vehicles = in_tens([_mavlink(name) for name in scene.agent_names])
    tabs = rrb.Tabs(numbers, *vehicles, active_tab=0)
    return rrb.Horizontal(mission, tabs, column_shares=[2, 3], name="Raw")


def _mavlink(name: str) -> rrb.View:
    """The newest of each kind of message that a vehicle sent."""
    return rrb.TextDocumentView(origin=f"/mavlink/{name}", name=f"MAVLink of {name}")
