"""How the viewer shows what agents knew: a tab for each, its beliefs over the truth beside a page in words."""

from __future__ import annotations

import rerun as rr
import rerun.blueprint as rrb

from missions.recording import palette
from missions.recording.event_view import event_log
from missions.recording.eye import eye_above
from missions.recording.scene import Scene

# More tabs in a row than this cannot be told apart.
_TABS_IN_A_ROW = 12
_GROUP = 10


def knowledge(scene: Scene) -> rrb.Container:
    """A tab for each agent; those of a large swarm in tens."""
    agents = [_mind(scene, name) for name in scene.agent_names]
    if len(agents) > _TABS_IN_A_ROW:
        agents = [
            rrb.Tabs(*agents[first : first + _GROUP], active_tab=0, name=f"A{first} to A{first + len(group) - 1}")
            for first in range(0, len(agents), _GROUP)
            if (group := agents[first : first + _GROUP])
        ]
    return rrb.Tabs(*agents, active_tab=0, name="Knowledge")


def _mind(scene: Scene, name: str) -> rrb.Container:
    page = rrb.TextDocumentView(origin=f"/knowledge/{name}", name="What it knew, and why it went there")
    lane = rrb.StateTimelineView(origin=f"/agents/{name}", name="What it did")
    words = rrb.Vertical(page, lane, event_log(f"/log/{name}", name="What it said"), row_shares=[6, 1.7, 3])
    return rrb.Horizontal(_beliefs(scene, name), words, column_shares=[5, 4], name=name)


def _beliefs(scene: Scene, name: str) -> rrb.View:
    position, target = eye_above(scene)
    agents, targets = (
        rr.Points3D.from_fields(colors=[palette.TRUE], radii=[radius], show_labels=False) for radius in (-1.5, -2.5)
    )
    return rrb.Spatial3DView(
        origin="/",
        contents=[f"/knowledge/{name}", "/world/arena/**", "/world/agents/body", "/world/targets/body"],
        name="Believed in color, with its age; true in gray, targets larger",
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital, position=position, look_target=target, eye_up=(0.0, 1.0, 0.0)
        ),
        overrides={"/world/agents/body": agents, "/world/targets/body": targets},
    )
