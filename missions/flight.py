"""A whole mission in one process: agents, their vehicles or links to them, the air between them, the world below.

with open_local_bus() as bus:
    flight = Flight(mission, bus)
    flight.run(pace=Lockstep(), observers=[metrics], stop=lambda: False)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import floor
from types import MappingProxyType

from comms.clock import Pace
from comms.frames import Vec3, swap_enu_ned
from comms.keys import Keys
from comms.messages import Sighting
from comms.radio import Radio
from comms.session import Bus
from comms.status import Activity, AgentStatus, Event, Level
from comms.transport import Transport
from missions import compose
from missions.coverage import Coverage
from missions.mission import Mission
from missions.observation import AgentTruth, Observation, Observer, Phase, TargetTruth
from swarm_agent.agent import Agent, Order, Output
from swarm_agent.autopilot import Phase as PilotPhase
from vehicle_sim.vehicle import VehicleTruth

# A preparation or a return that takes longer than this has gone wrong, whatever the pilots say.
PREPARE_LIMIT_S = 600.0
RETURN_LIMIT_S = 1800.0
# Between the last agent's arrival on its layer and the mission: an autopilot that is still ending its climb does not
# follow yet.
SETTLE_S = 2.0
_ENDED = (Activity.LANDED, Activity.LOST)


class Flight:
    """One mission from power-on to landed. Everything in it follows from the mission; only the pace comes from outside.

    Args:
        transports: open, by uid: of the agents whose vehicles are not simulated.

    Attributes:
        coverage: what was seen. ticks_flown: ticks of MISSION so far. complete: MISSION lasted its whole duration.
    """

    def __init__(self, mission: Mission, bus: Bus, transports: Mapping[int, Transport] = MappingProxyType({})) -> None:
        self.mission = mission
        self.world = compose.world(mission)
        self.agents = compose.agents(mission, len(self.world.places))
        self.vehicles = compose.vehicles(mission, [agent.pilot for agent in self.agents], transports)
        self.air = compose.air(mission, bus)
        keys = Keys(mission.name)
        self.radios = [Radio(bus, keys=keys, uid=uid) for uid in range(mission.agents.count)]
        self.coverage = Coverage()
        self.ticks_flown = 0
        self._homes = [(x, y, 0.0) for x, y in compose.deployment(mission)]
        self._telemetry = [b""] * mission.agents.count
        self._duration_ticks = max(1, round(mission.duration_s / mission.tick_s))
        self._phase = Phase.PREPARE
        self._phase_began = 0
        self._ticks = 0
        self._ready_since: int | None = None
        self._awaited = 0  # frames under way to the radios, due this tick

    @property
    def clock_s(self) -> float:
        """The mission clock: seconds since power-on."""
        return self._ticks * self.mission.tick_s

    @property
    def complete(self) -> bool:
        """Whether targets were watched for the mission's whole duration."""
        return self.ticks_flown >= self._duration_ticks

    def run(self, *, pace: Pace, observers: Iterable[Observer], stop: Callable[[], bool]) -> None:
        """Fly until everybody has landed or is lost.

        Args:
            stop: asked every tick; once true, the swarm comes home.
        """
        observers = tuple(observers)
        while self._phase is not Phase.DONE:
            observation = self._tick(self._ticks, pace.begin(self._ticks))
            for observer in observers:
                observer.observe(observation)
            self._ticks += 1
            self._turn_page(self._ticks, observation.statuses, stop())

    def _tick(self, tick: int, late_s: float) -> Observation:
        """Sense, hear, think, act, say; then everything moves from state `tick` to the next."""
        now_s = tick * self.mission.tick_s
        on_duty = self._phase is Phase.MISSION
        mission_tick = tick - self._phase_began if on_duty else None
        states = [vehicle.truth for vehicle in self.vehicles]
        truths = [self._truth(home, state) for home, state in zip(self._homes, states, strict=True)]
        places = [truth.position_m[:2] for truth in truths]
        aloft = [None if state.on_ground else place for state, place in zip(states, places, strict=True)]
        velocities = [truth.velocity_m_s[:2] for truth in truths]
        sightings = [[] for _ in places] if mission_tick is None else self.world.sense(mission_tick, aloft, velocities)
        order = Order(mission_tick=mission_tick, come_home=self._phase is Phase.RETURN)
        outputs = self._think(now_s, order, sightings)
        self._speak(tick, outputs, places)
        if on_duty:
            self.ticks_flown += 1
            self._count_coverage()
        observation = self._observe(tick, mission_tick, late_s, truths, outputs)
        if mission_tick is not None:
            self.world.advance(mission_tick, aloft)
        after_s = (tick + 1) * self.mission.tick_s
        self._telemetry = [
            vehicle.tick(after_s, output.wire) for vehicle, output in zip(self.vehicles, outputs, strict=True)
        ]
        return observation

    def _think(self, now_s: float, order: Order, sightings: Sequence[Sequence[Sighting]]) -> list[Output]:
        waiting = sum(radio.waiting for radio in self.radios)
        if waiting != self._awaited:
            raise RuntimeError(f"lockstep broken at {now_s:.1f} s: {waiting} frames arrived of {self._awaited}")
        return [
            agent.tick(now_s, order, seen, radio.drain(now_s), telemetry)
            for agent, seen, radio, telemetry in zip(self.agents, sightings, self.radios, self._telemetry, strict=True)
        ]

    def _speak(self, tick: int, outputs: Sequence[Output], places: Sequence[tuple[float, float]]) -> None:
        for radio, output in zip(self.radios, outputs, strict=True):
            if output.frame is not None:
                radio.send(output.frame)
        self._awaited = self.air.carry(tick, places)

    def _count_coverage(self) -> None:
        present = sum(1 for place in self.world.places if place is not None)
        self.coverage.add(seen=sum(self.world.seen), present=present)

    @staticmethod
    def _truth(home: Vec3, state: VehicleTruth) -> AgentTruth:
        offset = swap_enu_ned(state.position_ned_m)
        position: Vec3 = (home[0] + offset[0], home[1] + offset[1], home[2] + offset[2])
        return AgentTruth(position, swap_enu_ned(state.velocity_ned_m_s), state.yaw_rad)

    def _observe(
        self,
        tick: int,
        mission_tick: int | None,
        late_s: float,
        truths: Sequence[AgentTruth],
        outputs: Sequence[Output],
    ) -> Observation:
        on_duty = mission_tick is not None
        mean = self.coverage.mean if on_duty else None
        targets, seen = self.world.places, self.world.seen
        count = self.air.count
        return Observation(
            tick=tick,
            time_s=tick * self.mission.tick_s,
            mission_tick=mission_tick,
            phase=self._phase,
            statuses=tuple(output.status for output in outputs),
            truths=tuple(truths),
            targets=tuple(
                TargetTruth(0.0, 0.0, present=False, seen=False)
                if place is None
                else TargetTruth(place[0], place[1], present=True, seen=seen[target] and on_duty)
                for target, place in enumerate(targets)
            ),
            links=self.air.links,
            coverage=self.coverage.now if on_duty else None,
            coverage_mean=mean,
            utilization=None if mean is None else mean * len(targets) / len(outputs),
            tick_late_s=late_s,
            radio_sent=count.sent,
            radio_delivered=count.delivered,
            radio_bytes=count.bytes,
            events=self._announcement(tick),
        )

    def _announcement(self, tick: int) -> tuple[Event, ...]:
        if tick != self._phase_began:
            return ()
        text = {
            Phase.PREPARE: "preparing: connect, preflight, takeoff",
            Phase.MISSION: "the mission begins",
            Phase.RETURN: "returning: everybody lands at home",
        }[self._phase]
        return (Event(Level.INFO, text),)

    def _turn_page(self, next_tick: int, statuses: Sequence[AgentStatus], stop: bool) -> None:
        phase = self._next_phase(next_tick, statuses, stop)
        if phase is not self._phase:
            self._phase, self._phase_began = phase, next_tick

    def _next_phase(self, next_tick: int, statuses: Sequence[AgentStatus], stop: bool) -> Phase:
        in_phase_s = floor((next_tick - self._phase_began) * self.mission.tick_s)
        if self._phase is Phase.RETURN:
            over = all(self._has_ended(status) for status in statuses)
            return Phase.DONE if over or in_phase_s >= RETURN_LIMIT_S else Phase.RETURN
        if stop:
            return Phase.RETURN
        if self._phase is Phase.PREPARE:
            # An agent that cannot fly must not keep the others on the ground.
            waiting = [agent for agent, s in zip(self.agents, statuses, strict=True) if s.activity is not Activity.LOST]
            if not waiting or in_phase_s >= PREPARE_LIMIT_S:
                return Phase.RETURN
            return Phase.MISSION if self._settled(next_tick, waiting) else Phase.PREPARE
        nobody_left = all(self._has_ended(status) for status in statuses)
        return Phase.RETURN if self.complete or nobody_left else Phase.MISSION

    def _settled(self, tick: int, agents: Sequence[Agent]) -> bool:
        if not all(agent.ready for agent in agents):
            self._ready_since = None
            return False
        if self._ready_since is None:
            self._ready_since = tick
        return (tick - self._ready_since) * self.mission.tick_s >= SETTLE_S

    def _has_ended(self, status: AgentStatus) -> bool:
        """Landed, or lost and lying on the ground; one that is lost in the air may yet come down while it is heard."""
        if status.activity not in _ENDED:
            return False
        state = self.agents[status.uid].pilot.state
        unheard = state.link_lost and state.phase is PilotPhase.FAILED
        return unheard or self.vehicles[status.uid].truth.on_ground
