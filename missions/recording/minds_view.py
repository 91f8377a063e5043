"""How the viewer shows what agents knew: a tab for each, its beliefs over the truth beside a page in words."""

from __future__ import annotations

from collections.abc import Sequence

import rerun.blueprint as rrb

from missions.recording.event_view import event_log
from missions.recording.eye import eye_above
from missions.recording.scene import Scene

# More tabs in a row than this cannot be told apart.
_TABS_IN_A_ROW = 12
_GROUP = 10


def knowledge(scene: Scene) -> rrb.Container:
    """A tab for each agent; those of a large swarm in tens."""
    return rrb.Tabs(*in_tens([_mind(scene, name) for name in scene.agent_names]), active_tab=0, name="Knowledge")


def in_tens(agents: Sequence[rrb.View | rrb.Container]) -> Sequence[rrb.View | rrb.Container]:
    """Tabs, one for each agent; those of a large swarm in groups."""
    if len(agents) <= _TABS_IN_A_ROW:
        return agents
    groups = [agents[first : first + _GROUP] for first in range(0, len(agents), _GROUP)]
    return [
        rrb.Tabs(*group, active_tab=0, name=f"A{_GROUP * number} to A{_GROUP * number + len(group) - 1}")
        for number, group in enumerate(groups)
    ]


def _mind(scene: Scene, name: str) -> rrb.Container:
    page = rrb.TextDocumentView(origin=f"/knowledge/{name}", name="What it knew, and why it went there")
    lane = rrb.StateTimelineView(origin=f"/agents/{name}", name="What it did")
    words = rrb.Vertical(page, lane, event_log(f"/log/{name}", name="What it said"), row_shares=[6, 1.7, 3])
    return rrb.Horizontal(_beliefs(scene, name), words, column_shares=[5, 4], name=name)


def _beliefs(scene: Scene, name: str) -> rrb.View:
    position, target = eye_above(scene)
    return rrb.Spatial3DView(
        origin="/",
        contents=[f"/knowledge/{name}", "/truth/**", "/world/arena/**"],
        name="Believed in color, with its age; true in gray, targets larger",
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital, position=position, look_target=target, eye_up=(0.0, 1.0, 0.0)
        ),
    )
