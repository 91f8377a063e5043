"""The agents' side of a tick: one agent, its radio and its vehicle."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType

from comms.frames import Vec3, swap_enu_ned
from comms.keys import Keys
from comms.mavlink import Endpoint
from comms.radio import Radio
from comms.session import Bus
from comms.status import Activity, AgentStatus
from comms.transport import Transport
from missions import compose
from missions.mission import Mission
from missions.observation import AgentTruth
from missions.sides.exchange import HELLO_TICK, Cue, Done, LinkCount
from missions.vehicles import Vehicle
from swarm_agent.agent import Agent, Order
from swarm_agent.autopilot import Phase as PilotPhase
from vehicle_sim.autopilot import SimulatedVehicle

# Told at every tick: the mission clock, what the vehicle has said by now, what the agent says to it.
Tap = Callable[[float, bytes, bytes], None]


class AgentSide:
    """Agent `uid` with all that is its own, one `Cue` in and one `Done` out a tick.

    Args:
        pad_m: where its vehicle stands at first, ENU meters: what its truth counts from.

    Attributes:
        tap: hears what passes on the link to the vehicle, if anybody wants to.
    """

    def __init__(self, agent: Agent, vehicle: Vehicle, radio: Radio, *, pad_m: Vec3, tick_s: float) -> None:
        self.uid = agent.uid
        self.agent = agent
        self.vehicle = vehicle
        self.radio = radio
        self._pad_m = pad_m
        self._tick_s = tick_s
        self._telemetry = b""
        self.tap: Tap | None = None

    def hello(self) -> Done:
        """It is there, and stands where it stands."""
        return self._done(HELLO_TICK, AgentStatus(uid=self.uid, activity=Activity.PREPARING), spoke=False)

    def tick(self, cue: Cue) -> Done:
        """Hear, think, act, say; then the vehicle moves to the next state.

        Raises:
            RuntimeError: the inbox is not what was sent to it.
        """
        now_s, after_s = cue.tick * self._tick_s, (cue.tick + 1) * self._tick_s
        if cue.frames is not None and self.radio.waiting != cue.frames:
            got = f"{self.radio.waiting} frames arrived of {cue.frames}"
            raise RuntimeError(f"lockstep broken at {now_s:.1f} s, agent {self.uid}: {got}")
        order = Order(mission_tick=cue.mission_tick, come_home=cue.come_home, explain=cue.explain)
        output = self.agent.tick(now_s, order, cue.sightings, self.radio.drain(now_s), self._telemetry)
        if self.tap is not None:
            self.tap(now_s, self._telemetry, output.wire)
        if output.frame is not None:
            self.radio.send(output.frame)
        self._telemetry = self.vehicle.tick(after_s, output.wire)
        return self._done(cue.tick, output.status, spoke=output.frame is not None)

    def _done(self, tick: int, status: AgentStatus, *, spoke: bool) -> Done:
        truth, pilot = self.vehicle.truth, self.agent.pilot
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
            unheard=state.link_lost and state.phase is PilotPhase.FAILED,
            pilot=_count([pilot.endpoint]),
            vehicle=_count(
                [channel.endpoint for channel in self.vehicle.channels]
                if isinstance(self.vehicle, SimulatedVehicle)
                else []
            ),
        )


def agent_sides(
    mission: Mission,
    bus: Bus,
    uids: Iterable[int],
    *,
    n_targets: int,
    transports: Mapping[int, Transport] = MappingProxyType({}),
) -> list[AgentSide]:
    """These agents of a mission, each with its vehicle just switched on, or behind its open transport.

    Raises:
        InputError: weights of the learned predictor that cannot be read.
    """
    agents = compose.agents(mission, uids, n_targets)
    vehicles = compose.vehicles(mission, [agent.pilot for agent in agents], transports)
    keys, places = Keys(mission.name), compose.deployment(mission)
    return [
        AgentSide(
            agent,
            vehicle,
            Radio(bus, keys=keys, uid=agent.uid),
            pad_m=(*places[agent.uid], 0.0),
            tick_s=mission.tick_s,
        )
        for agent, vehicle in zip(agents, vehicles, strict=True)
    ]


def _count(endpoints: Iterable[Endpoint]) -> LinkCount:
    sent = received = bad = dropped = 0
    for end in endpoints:
        sent, received = sent + end.sent, received + end.received
        bad, dropped = bad + end.bad, dropped + end.dropped
    return LinkCount(sent, received, bad, dropped)
