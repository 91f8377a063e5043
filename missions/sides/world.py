"""The world's side of a tick: the targets, what is sensed of them, the air, the phases, and what observers are told."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Protocol

from comms.clock import Pace
from comms.messages import Sighting
from comms.session import Bus
from comms.status import Activity
from missions import compose
from missions.coverage import Coverage
from missions.faults.schedule import Schedule
from missions.mission import Mission
from missions.observation import Observation, Observer, Phase, TargetTruth, Totals
from missions.sides.exchange import Cue, Done
from missions.sides.phases import Phases


class Crew(Protocol):
    """All agents of a mission, wherever they run."""

    def tick(self, cues: Sequence[Cue]) -> Sequence[Done]:
        """What came of each one's cue, by uid."""


class WorldSide:
    """A mission without its agents, from power-on to landed.

    Attributes:
        world: the targets. medium: what carries frames. coverage: what was seen.
        dones: what the agents did last, by uid.
        explain_every_s: how often agents tell what they know; None: never.
    """

    def __init__(self, mission: Mission, bus: Bus) -> None:
        self.mission = mission
        self.world = compose.world(mission)
        self.medium = compose.medium(mission, bus)
        self.coverage = Coverage()
        self.explain_every_s: float | None = None
        self.dones: Sequence[Done] = ()
        self._phases = Phases(tick_s=mission.tick_s, duration_s=mission.duration_s)
        self._tick = 0
        self._late_s = 0.0
        self._faults = Schedule(mission)

    @property
    def tick(self) -> int:
        """The tick that comes next, or is under way."""
        return self._tick

    @property
    def clock_s(self) -> float:
        """The mission clock: seconds since power-on."""
        return self._tick * self.mission.tick_s

    @property
    def ticks_flown(self) -> int:
        """Ticks of MISSION so far."""
        return self._phases.ticks_flown

    @property
    def complete(self) -> bool:
        """Whether targets were watched for the mission's whole duration."""
        return self._phases.complete

    @property
    def over(self) -> bool:
        """Whether everybody has landed or is lost."""
        return self._phases.now is Phase.DONE

    def meet(self, hellos: Sequence[Done]) -> None:
        """Everybody is there, by uid, and stands where it stands."""
        self.dones = hellos

    def cue(self, late_s: float) -> list[Cue]:
        """Begin a tick, `late_s` behind the wall clock: what each agent is told, by uid."""
        self._late_s = late_s
        mission_tick, fault_tick = self._phases.mission_tick(self._tick), self._phases.fault_tick(self._tick)
        if mission_tick is None:
            sightings: list[list[Sighting]] = [[] for _ in self.dones]
        else:
            velocities = [done.truth.velocity_m_s[:2] for done in self.dones]
            ills = self._faults.at(fault_tick)
            lost = [done.status.activity is Activity.LOST for done in self.dones]  # who knows where they are?
            watching = [None if lost[uid] or ills.stopped(uid) else place for uid, place in enumerate(self._aloft())]
            sightings = self.world.sense(mission_tick, watching, velocities, ills.identity_errors)
        return [
            Cue(
                tick=self._tick,
                mission_tick=mission_tick,
                fault_tick=fault_tick,
                come_home=self._phases.now is Phase.RETURN,
                explain=self._is_explained(),
                sightings=tuple(seen),
                frames=frames,
                late_s=late_s,
            )
            for seen, frames in zip(sightings, self.medium.due, strict=True)
        ]

    def conclude(self, dones: Sequence[Done]) -> Observation:
        """Given what came of the cues, by uid: what was said travels, and targets move on. Returns what was."""
        before, aloft, tick = self.dones, self._aloft(), self._tick
        mission_tick = self._phases.mission_tick(tick)
        links = self._faults.at(self._phases.fault_tick(tick)).links
        self.medium.carry(tick, before, dones, links)
        if mission_tick is not None:
            present = sum(1 for place in self.world.places if place is not None)
            self.coverage.add(seen=sum(self.world.seen), present=present)
        observation = self._observe(mission_tick, before, dones)
        if mission_tick is not None:
            self.world.advance(mission_tick, aloft)
        self.dones = dones
        return observation

    def turn(self, *, stop: bool) -> None:
        """End the tick. `stop`: the swarm is to come home."""
        self._tick += 1
        self._phases.turn(self._tick, self.dones, stop=stop)

    def _is_explained(self) -> bool:
        every_s = self.explain_every_s
        return every_s is not None and self._tick % max(1, round(every_s / self.mission.tick_s)) == 0

    def _aloft(self) -> list[tuple[float, float] | None]:
        return [None if done.on_ground else done.truth.position_m[:2] for done in self.dones]

    def _observe(self, mission_tick: int | None, before: Sequence[Done], dones: Sequence[Done]) -> Observation:
        on_duty = mission_tick is not None
        mean = self.coverage.mean if on_duty else None
        targets, seen = self.world.places, self.world.seen
        return Observation(
            tick=self._tick,
            time_s=self.clock_s,
            mission_tick=mission_tick,
            phase=self._phases.now,
            statuses=tuple([done.status for done in dones]),
            truths=tuple([done.truth for done in before]),
            targets=tuple(
                TargetTruth(0.0, 0.0, present=False, seen=False)
                if place is None
                else TargetTruth(place[0], place[1], present=True, seen=seen[target] and on_duty)
                for target, place in enumerate(targets)
            ),
            links=self.medium.links,
            broken=self.medium.broken,
            coverage=self.coverage.now if on_duty else None,
            coverage_mean=mean,
            utilization=None if mean is None else mean * len(targets) / len(dones),
            tick_late_s=self._late_s,
            totals=self._totals(dones),
            events=self._phases.announcement(self._tick) + self._faults.news(self._phases.fault_tick(self._tick)),
        )

    def _totals(self, dones: Sequence[Done]) -> Totals:
        count, pilots, vehicles = self.medium.count, [done.pilot for done in dones], [done.vehicle for done in dones]
        return Totals(
            radio_sent=count.sent,
            radio_delivered=count.delivered,
            radio_out_of_range=count.out_of_range,
            radio_lost=count.lost,
            radio_refused=count.refused + sum(done.radio.refused for done in dones),
            radio_bytes=count.bytes,
            mavlink_sent=sum(end.sent for end in pilots),
            mavlink_received=sum(end.received for end in pilots),
            mavlink_bad=sum(end.bad for end in pilots),
            mavlink_dropped=sum(end.dropped for end in pilots),
            vehicles_received=sum(end.received for end in vehicles),
            vehicles_bad=sum(end.bad for end in vehicles),
            vehicles_dropped=sum(end.dropped for end in vehicles),
        )


def fly(world: WorldSide, crew: Crew, *, pace: Pace, observers: Iterable[Observer], stop: Callable[[], bool]) -> None:
    """Fly a mission whose crew is met, until everybody has landed or is lost.

    Args:
        stop: asked every tick; once true, the swarm comes home.
    """
    observers = tuple(observers)
    while not world.over:
        dones = crew.tick(world.cue(pace.begin(world.tick)))
        observation = world.conclude(dones)
        for observer in observers:
            observer.observe(observation)
        world.turn(stop=stop())
