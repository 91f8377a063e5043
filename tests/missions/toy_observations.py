"""A toy mission to draw: agents chase wandering targets, call for help and get it. Deterministic, and no algorithm."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import atan2, cos, hypot, pi, sin

from comms.arena import Arena, rectangle
from comms.chance import draw
from comms.frames import GeoPoint
from comms.status import Activity, AgentStatus, Event, HelpCallStatus, Level
from missions.observation import AgentTruth, Observation, Phase, TargetTruth, Totals
from missions.recording import Scene

_TURN, _START = 101, 102
PREPARATION = 50


def toy_scene(*, arena: Arena | None = None, n_agents: int = 10, n_targets: int = 10, seed: int = 1) -> Scene:
    """A scene of ten agents and ten targets in a square of 300 m, unless told otherwise."""
    arena = arena or rectangle(300.0, 300.0)
    return Scene(
        mission_name="toy",
        mission_yaml=f"name: toy\nseed: {seed}\nagents:\n  count: {n_agents}\ntargets:\n  count: {n_targets}\n",
        seed=seed,
        policy="toy",
        versions={"rerun-sdk": "0.41", "git": "0000000"},
        tick_s=0.1,
        arena=arena,
        n_agents=n_agents,
        n_targets=n_targets,
        sensing_ranges_m=(0.13 * 2 * max(arena.half_x_m, arena.half_y_m),) * n_agents,
        home=GeoPoint(47.3769, 8.5417, 408.0),
        ceiling_m=0.16 * min(arena.half_x_m, arena.half_y_m),
        coverage_floor=0.41,
    )


def _reach_m(scene: Scene) -> float:
    return min(scene.arena.half_x_m, scene.arena.half_y_m)


@dataclass
class _Mover:
    """Something that goes straight ahead, turns a little by chance, and turns back at the border."""

    who: int
    x: float
    y: float
    course: float
    speed: float
    goal: tuple[float, float] | None = None

    def step(self, scene: Scene, tick: int) -> None:
        half = _reach_m(scene) * 0.92
        if self.goal is not None:
            self._turn_to(self.goal, 0.12)
        elif hypot(self.x, self.y) > half:
            self._turn_to((0.0, 0.0), 0.08)
        else:
            self.course += 0.12 * (draw(scene.seed, tick, self.who, _TURN) - 0.5)
        self.x += self.speed * scene.tick_s * cos(self.course)
        self.y += self.speed * scene.tick_s * sin(self.course)

    def _turn_to(self, place: tuple[float, float], rate: float) -> None:
        wanted = atan2(place[1] - self.y, place[0] - self.x)
        off = (wanted - self.course + pi) % (2 * pi) - pi
        self.course += max(-rate, min(rate, off))


@dataclass
class _Toy:
    scene: Scene
    agents: list[_Mover]
    targets: list[_Mover]
    activities: list[Activity] = field(default_factory=list)
    coverages: list[float] = field(default_factory=list)
    sent: int = 0
    delivered: int = 0

    @classmethod
    def start(cls, scene: Scene) -> _Toy:
        reach = _reach_m(scene)
        pace = reach / 20.0

        def mover(who: int, speed: float) -> _Mover:
            u, v, w = (draw(scene.seed, k, who, _START) for k in range(3))
            away, around = 0.9 * reach * u**0.5, 2 * pi * v
            return _Mover(who, away * cos(around), away * sin(around), 2 * pi * w, speed)

        agents = [mover(uid, pace) for uid in range(scene.n_agents)]
        targets = [mover(1000 + uid, 0.55 * pace) for uid in range(scene.n_targets)]
        return cls(scene, agents, targets, [Activity.PREPARING] * scene.n_agents)

    def distance(self, agent: int, target: int) -> float:
        a, t = self.agents[agent], self.targets[target]
        return hypot(a.x - t.x, a.y - t.y)

    def observe(self, tick: int) -> Observation:
        moving = tick >= PREPARATION
        if moving:
            for target in self.targets:
                target.step(self.scene, tick)
        owners = self._owners() if moving else {}
        statuses = tuple(self._status(uid, tick, owners) for uid in range(self.scene.n_agents))
        for uid, agent in enumerate(self.agents):
            if moving and not self._is_lost(uid, tick):
                agent.step(self.scene, tick)
        seen = [self._is_seen(target) for target in range(self.scene.n_targets)]
        links = self._links()
        self.sent += self.scene.n_agents
        self.delivered += 2 * len(links)
        if moving:
            self.coverages.append(sum(seen) / max(1, len(seen)))
        mean = sum(self.coverages) / len(self.coverages) if moving else None
        return Observation(
            tick=tick,
            mission_tick=tick - PREPARATION if moving else None,
            time_s=tick * self.scene.tick_s,
            phase=Phase.MISSION if moving else Phase.PREPARE,
            statuses=statuses,
            truths=tuple(self._truth(uid, tick) for uid in range(self.scene.n_agents)),
            targets=tuple(
                TargetTruth(t.x, t.y, present=not (uid == 3 and tick < 150), seen=seen[uid])
                for uid, t in enumerate(self.targets)
            ),
            links=links,
            coverage=self.coverages[-1] if moving else None,
            coverage_mean=mean,
            utilization=mean,
            tick_late_s=0.001 * draw(self.scene.seed, tick, 0, _TURN),
            totals=Totals(radio_sent=self.sent, radio_delivered=self.delivered),
            events=(Event(Level.INFO, "mission starts"),) if tick == PREPARATION else (),
        )

    def _is_lost(self, uid: int, tick: int) -> bool:
        return uid == 6 and 350 <= tick < 470

    def _is_seen(self, target: int) -> bool:
        return any(self.distance(uid, target) < self.scene.sensing_ranges_m[0] for uid in range(self.scene.n_agents))

    def _owners(self) -> dict[int, list[int]]:
        owners: dict[int, list[int]] = {}
        for target in range(self.scene.n_targets):
            nearest = min(range(self.scene.n_agents), key=lambda uid: self.distance(uid, target))
            if self.distance(nearest, target) < self.scene.sensing_ranges_m[0]:
                owners.setdefault(nearest, []).append(target)
        return owners

    def _links(self) -> tuple[tuple[int, int], ...]:
        near = 2.2 * self.scene.sensing_ranges_m[0]
        return tuple(
            (a, b)
            for a in range(self.scene.n_agents)
            for b in range(a + 1, self.scene.n_agents)
            if hypot(self.agents[a].x - self.agents[b].x, self.agents[a].y - self.agents[b].y) < near
        )

    def _status(self, uid: int, tick: int, owners: dict[int, list[int]]) -> AgentStatus:
        tags = owners.get(uid, [])
        far = [t for t in tags if self.distance(uid, t) > 0.62 * self.scene.sensing_ranges_m[0]]
        calls = tuple(HelpCallStatus(target, 4.0) for target in far[1:] or (far if len(tags) > 1 else []))
        helping = None if tags else self._helping(uid, owners)
        activity = Activity.PREPARING
        if tick >= PREPARATION:
            activity = Activity.CALLING if calls else Activity.FOLLOW if tags else Activity.EXPLORE
            activity = Activity.HELPING if helping is not None else activity
        if self._is_lost(uid, tick):
            activity, tags, calls, helping = Activity.LOST, [], (), None
        self._steer(uid, tags, helping)
        events = self._events(uid, activity)
        self.activities[uid] = activity
        agent = self.agents[uid]
        return AgentStatus(
            uid=uid,
            activity=activity,
            position_m=(agent.x, agent.y, 30.0),
            velocity_m_s=(agent.speed * cos(agent.course), agent.speed * sin(agent.course), 0.0),
            heading_rad=pi / 2 - agent.course,
            battery=1.0 - 0.0004 * tick * (1 + 0.1 * uid),
            tags=tuple(tags),
            calls=calls,
            helping=helping,
            flight_mode="GUIDED",
            events=events,
        )

    def _helping(self, uid: int, owners: dict[int, list[int]]) -> int | None:
        crowded = [tags[-1] for tags in owners.values() if len(tags) > 1]
        near = [t for t in crowded if self.distance(uid, t) < 3 * self.scene.sensing_ranges_m[0]]
        return min(near, key=lambda t: self.distance(uid, t)) if near and uid % 2 == 0 else None

    def _steer(self, uid: int, tags: list[int], helping: int | None) -> None:
        agent = self.agents[uid]
        wanted = tags or ([] if helping is None else [helping])
        places = [(self.targets[t].x, self.targets[t].y) for t in wanted]
        agent.goal = (
            (sum(x for x, _ in places) / len(places), sum(y for _, y in places) / len(places)) if places else None
        )

    def _events(self, uid: int, activity: Activity) -> tuple[Event, ...]:
        if activity is self.activities[uid]:
            return ()
        if activity is Activity.LOST:
            return (Event(Level.ERROR, "not heard for 3 s"),)
        return ()

    def _truth(self, uid: int, tick: int) -> AgentTruth:
        agent = self.agents[uid]
        height = _reach_m(self.scene) * 0.16 * min(1.0, max(0.0, tick / 40))
        return AgentTruth(
            position_m=(agent.x, agent.y, height),
            velocity_m_s=(agent.speed * cos(agent.course), agent.speed * sin(agent.course), 0.0),
            heading_rad=pi / 2 - agent.course,
        )


def toy_observations(scene: Scene, *, ticks: int = 650) -> Iterator[Observation]:
    """`ticks` observations: preparation for five seconds, then the mission."""
    toy = _Toy.start(scene)
    for tick in range(ticks):
        yield toy.observe(tick)
