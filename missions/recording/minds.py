"""What each agent knew, beside the truth: its beliefs in space, and a page that says what it wanted and why."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import rerun as rr

from comms.knowledge import Belief, Knowledge
from comms.status import Activity, AgentStatus
from missions.observation import Observation, TargetTruth
from missions.recording import palette
from missions.recording.block import Block, Floats, stored
from missions.recording.columns import Rows, on_ground, rings, strips
from missions.recording.scene import Scene

# An arrow as long as the way of so many seconds.
_ARROW_S = 4.0
# News older than this is shown with its age.
_FRESH_S = 1.0
_HEADER = "| target | east, north m | known | follows | calls | lost in | comes | in | off by |\n" + "|---" * 9 + "|"


class _Told(NamedTuple):
    """One agent's knowledge at one tick, with what it is held against."""

    observation: Observation
    status: AgentStatus
    knowledge: Knowledge

    @property
    def me(self) -> tuple[float, float]:
        """Where it believes to be; where it is while it knows nothing of that."""
        place = self.status.position_m or self.observation.truths[self.status.uid].position_m
        return place[:2]

    def truth(self, belief: Belief) -> TargetTruth:
        """The target that is believed in."""
        return self.observation.targets[belief.target]


class Minds:
    """Draws what agents knew whenever they tell it, and what was so: `/knowledge/A4` is the mind of A4.

    The truth of those moments is kept once for all minds. A style of it in each mind's view would be the larger part
    of a short recording.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def rows(self, block: Block) -> Iterator[Rows]:
        """Rows for each agent that has told, and for the truth."""
        for uid, name in enumerate(self._scene.agent_names):
            told = [
                _Told(seen, seen.statuses[uid], knowledge)
                for seen in block.observations
                if (knowledge := seen.statuses[uid].knowledge) is not None
            ]
            if told:
                at = Block(self._scene, [one.observation for one in told])
                yield Rows(f"/knowledge/{name}", at, self._columns(uid, told))
        yield from self._truth(Block(self._scene, [seen for seen in block.observations if _anybody_told(seen)]))

    def _truth(self, block: Block) -> Iterator[Rows]:
        present = block.present
        targets = rr.Points3D.columns(positions=block.targets_m[present]).partition(present.sum(axis=1))
        agents = rr.Points3D.columns(positions=block.positions_m.reshape(-1, 3))
        yield Rows("/truth/agents", block, agents.partition([self._scene.n_agents] * len(block)))
        yield Rows("/truth/targets", block, targets)

    def _columns(self, uid: int, told: Sequence[_Told]) -> list[rr.ComponentColumn]:
        return [
            *_points(self._scene, told),
            *_lines(told),
            *_sight(told, self._scene.sensing_ranges_m[uid]),
            *rr.TextDocument.columns(text=[page(self._scene, one.status, one.observation) for one in told]),
        ]


def _anybody_told(seen: Observation) -> bool:
    return any(status.knowledge is not None for status in seen.statuses)


def _points(scene: Scene, told: Sequence[_Told]) -> rr.ComponentColumnList:
    """The agent itself, the targets it believes in, and the mates it has heard."""
    places, colors, labels, counts = [], [], [], []
    for one in told:
        status, known = one.status, one.knowledge
        places += [one.me, *(b.place_m for b in known.beliefs), *(m.place_m for m in known.mates)]
        colors += [
            palette.ACTIVITY_INKS[status.activity],
            *(_color(status, belief) for belief in known.beliefs),
            *(palette.MATE for _ in known.mates),
        ]
        labels += [
            scene.agent_names[status.uid],
            *(_dated(f"T{belief.target}", belief.age_s) for belief in known.beliefs),
            *(_dated(f"A{mate.uid}", mate.age_s) for mate in known.mates),
        ]
        counts.append(1 + len(known.beliefs) + len(known.mates))
    points = rr.Points3D.columns(positions=_flat(places), colors=np.array(colors, dtype=np.uint32), labels=labels)
    return points.partition(counts)


def _sight(told: Sequence[_Told], range_m: float) -> rr.ComponentColumnList:
    """How far it sees."""
    centers = _flat([one.me for one in told])
    colors = np.array([palette.ACTIVITY_INKS[one.status.activity] for one in told], dtype=np.uint32)
    return rings(centers, range_m, colors, np.ones(len(told), dtype=np.int64))


def _lines(told: Sequence[_Told]) -> rr.ComponentColumnList:
    """Where it wants to go, and from where each target is believed to be to where it is: one batch of lines."""
    lines: list[npt.NDArray[np.float64]] = []
    colors, counts = [], []
    for one in told:
        own = palette.ACTIVITY_INKS[one.status.activity]
        pairs = [(belief, truth) for belief in one.knowledge.beliefs if (truth := one.truth(belief)).present]
        lines.append(_arrow(one.me, one.knowledge.wanted_m_s))
        lines += [np.array((belief.place_m, (truth.x_m, truth.y_m))) for belief, truth in pairs]
        colors += [own, *(_color(one.status, belief) for belief, _ in pairs)]
        counts.append(1 + len(pairs))
    lengths = np.array([len(line) for line in lines])
    return strips(
        _flat(np.concatenate(lines)), lengths, np.array(colors, dtype=np.uint32), np.array(counts, dtype=np.int64)
    )


def _arrow(tail: tuple[float, float], velocity_m_s: tuple[float, float]) -> npt.NDArray[np.float64]:
    """From a place to where it would be some seconds later, in one stroke: (5, 2)."""
    start, way = np.array(tail), _ARROW_S * np.array(velocity_m_s)
    across = np.array((-way[1], way[0]))
    tip = start + way
    barbs = [tip - 0.3 * way + side * 0.15 * across for side in (1.0, -1.0)]
    return np.array((start, tip, barbs[0], tip, barbs[1]))


def _flat(places: npt.ArrayLike) -> Floats:
    return on_ground(stored(np.asarray(places, dtype=np.float64).reshape(-1, 2)))


def _color(status: AgentStatus, belief: Belief) -> int:
    """What a belief means to the agent: its own, to be helped, called for, a mate's, seen, or a memory."""
    if belief.target == status.helping:
        return palette.ACTIVITY_INKS[Activity.HELPING]
    if belief.caller is not None:
        return palette.ACTIVITY_INKS[Activity.CALLING]
    if belief.owner == status.uid:
        return palette.ACTIVITY_INKS[Activity.FOLLOW]
    if belief.owner is not None:
        return palette.TAGGED
    return palette.SEEN if belief.sensed else palette.REMEMBERED


def _dated(name: str, age_s: float) -> str:
    """A label in space, which is to be short."""
    return name if age_s < _FRESH_S else f"{name} · {age_s:.0f} s"


def _age(age_s: float) -> str:
    return "" if age_s < _FRESH_S else f", {age_s:.0f} s ago"


def page(scene: Scene, status: AgentStatus, observation: Observation) -> str:
    """What an agent knew and wanted, as Markdown; empty of beliefs while it is not on duty."""
    known = status.knowledge or Knowledge()
    title = f"### {scene.agent_names[status.uid]}: {status.activity.value} at {observation.time_s:.1f} s"
    east, north = known.wanted_m_s
    wish = [f"**{known.why}** (at {hypot(east, north):.1f} m/s)"] if known.why else []
    rows = [_row(belief, observation.targets[belief.target]) for belief in known.beliefs]
    beliefs = ["\n".join((_HEADER, *rows))] if rows else ["It knows of no target."]
    heard = ", ".join(f"A{mate.uid}{_age(mate.age_s)}" for mate in known.mates)
    return "\n\n".join((title, *wish, *beliefs, f"It hears {heard or 'nobody'}."))


def _row(belief: Belief, truth: TargetTruth) -> str:
    x, y = belief.place_m
    known = "sees it" if belief.sensed else f"{belief.age_s:.1f} s ago"
    off = f"{hypot(x - truth.x_m, y - truth.y_m):.1f} m" if truth.present else "it is gone"
    cells = (
        f"T{belief.target}",
        f"{x:.1f}, {y:.1f}",
        known,
        _who(belief.owner),
        _who(belief.caller),
        _seconds(belief.loss_in_s),
        _who(belief.answerer),
        _seconds(belief.capture_s),
        off,
    )
    return f"| {' | '.join(cells)} |"


def _who(uid: int | None) -> str:
    return "" if uid is None else f"A{uid}"


def _seconds(span_s: float | None) -> str:
    return "" if span_s is None else f"{span_s:.1f} s"
