"""The agents' side of a tick: one agent, its radio and its vehicle."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MappingProxyType

from msgspec import structs

from comms.frames import Vec3, swap_enu_ned
from comms.mavlink import Endpoint
from comms.radio import Radio
from comms.status import Activity, AgentStatus, Event, Level
from comms.transport import Transport
from missions import compose
from missions.faults.breaker import Breaker
from missions.faults.schedule import Schedule
from missions.mission import Mission
from missions.observation import AgentTruth
from missions.sides.computer import Computer
from missions.sides.exchange import HELLO_TICK, Cue, Done, LinkCount, RadioTally
from missions.vehicles import LinkedVehicle, Vehicle
from swarm_agent.agent import Agent, Output
from swarm_agent.autopilot import Phase as PilotPhase
from vehicle_sim.autopilot import SimulatedVehicle

# Told at every tick: the mission clock, what the vehicle has said by now, what the agent says to it.
Tap = Callable[[float, bytes, bytes], None]
NOTHING_COUNTED = LinkCount()
LEFT_BEHIND = "its vehicle is left in the air: nobody flies it"


class AgentSide:
    """Agent `uid` with all that is its own, one `Cue` in and one `Done` out a tick.

    Args:
        pad_m: where its vehicle stands at first, ENU meters: what its truth counts from.
        faults: what goes wrong with it, and when.

    Attributes:
        tap: hears what passes on the link to the vehicle, if anybody wants to.
    """

    def __init__(
        self, agent: Agent, vehicle: Vehicle, radio: Radio, *, pad_m: Vec3, tick_s: float, faults: Schedule
    ) -> None:
        self.uid = agent.uid
        self.vehicle = vehicle
        self.computer = Computer(agent, radio)
        self._faults = faults
        self._breaker = Breaker(vehicle) if isinstance(vehicle, SimulatedVehicle) else None
        self._former = LinkCount()  # of agents before this one
        self._pad_m = pad_m
        self._tick_s = tick_s
        self._said = b""  # by the vehicle, at the end of the last tick
        self._has_told = False
        self.tap: Tap | None = None

    @property
    def agent(self) -> Agent:
        """The agent as its computer runs it now."""
        return self.computer.agent

    def hello(self) -> Done:
        """It is there, and stands where it stands."""
        return self._done(HELLO_TICK, AgentStatus(uid=self.uid, activity=Activity.PREPARING))

    def tick(self, cue: Cue) -> Done:
        """Hear, think, act, say; then the vehicle moves to the next state.

        Raises:
            RuntimeError: the inbox is not what was sent to it.
        """
        now_s, after_s = cue.tick * self._tick_s, (cue.tick + 1) * self._tick_s
        if self._breaker is not None:
            self._breaker.apply(self._faults, self.uid, cue.fault_tick)
        output = self._think(cue, now_s)
        if self.tap is not None:
            self.tap(now_s, self._said, output.wire)
        self._said = self.vehicle.tick(after_s, output.wire)
        self.computer.take(self._said)
        abandoned = self._abandoned(cue)
        status = self._with_last_words(output.status) if abandoned and cue.come_home else output.status
        return self._done(cue.tick, status, spoke=output.frame is not None, abandoned=abandoned)

    def _think(self, cue: Cue, now_s: float) -> Output:
        ills, before = self._faults.at(cue.fault_tick), self.agent
        if self.uid in ills.dead:
            return self.computer.go_out(now_s)
        if self.uid in ills.frozen:
            return self.computer.stand_still(now_s)
        output = self.computer.think(cue, now_s)
        if self.agent is not before:
            self._former = _count([before.pilot.endpoint], beside=self._former)
            if isinstance(self.vehicle, LinkedVehicle):
                self.vehicle.pilot = self.agent.pilot
        return output

    def _with_last_words(self, status: AgentStatus) -> AgentStatus:
        """When all come home, and nobody is there to bring home its vehicle, that is told once."""
        if self._has_told or self.vehicle.truth.on_ground:
            return status
        self._has_told = True
        return structs.replace(status, events=(*status.events, Event(Level.ERROR, LEFT_BEHIND)))

    def _abandoned(self, cue: Cue) -> bool:
        """Whether nobody will ever wait for it again."""
        tick = cue.fault_tick
        if tick is None or not self._faults.at(tick).stopped(self.uid):
            return False
        return not self._faults.comes_back(self.uid, tick)

    def _done(self, tick: int, status: AgentStatus, *, spoke: bool = False, abandoned: bool = False) -> Done:
        truth, pilot, heard = self.vehicle.truth, self.agent.pilot, self.computer.radio.count
        east, north, up = swap_enu_ned(truth.position_ned_m)
        pad = self._pad_m
        state = pilot.state
        return Done(
            tick=tick,
            status=status,
            truth=AgentTruth(
                (pad[0] + east, pad[1] + north, pad[2] + up), swap_enu_ned(truth.velocity_ned_m_s), truth.yaw_rad
            ),
            on_ground=truth.on_ground,
            spoke=spoke,
            ready=state.ready,
            unheard=abandoned or (state.link_lost and state.phase is PilotPhase.FAILED),
            radio=RadioTally(heard.sent, heard.bytes, heard.accepted, heard.refused),
            pilot=_count([pilot.endpoint], beside=self._former),
            vehicle=_count(
                [channel.endpoint for channel in self.vehicle.channels]
                if isinstance(self.vehicle, SimulatedVehicle)
                else []
            ),
        )


def agent_sides(
    mission: Mission,
    radios: Sequence[Radio],
    *,
    n_targets: int,
    transports: Mapping[int, Transport] = MappingProxyType({}),
    started_tick: int = 0,
) -> list[AgentSide]:
    """The agents with these radios, each with its vehicle just switched on, or behind its open transport.

    Args:
        started_tick: when that is; later than 0 for an agent that comes back.

    Raises:
        InputError: weights of the learned predictor that cannot be read.
    """
    agents = compose.agents(mission, [radio.uid for radio in radios], n_targets)
    pilots, places, faults = [agent.pilot for agent in agents], compose.deployment(mission), Schedule(mission)
    vehicles = compose.vehicles(mission, pilots, transports, started_at_s=started_tick * mission.tick_s)
    return [
        AgentSide(agent, vehicle, radio, pad_m=(*places[radio.uid], 0.0), tick_s=mission.tick_s, faults=faults)
        for agent, vehicle, radio in zip(agents, vehicles, radios, strict=True)
    ]


def _count(endpoints: Iterable[Endpoint], *, beside: LinkCount = NOTHING_COUNTED) -> LinkCount:
    counts = (LinkCount(end.sent, end.received, end.bad, end.dropped) for end in endpoints)
    return sum(counts, start=beside)
