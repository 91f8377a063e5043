"""One agent: the brain and its hands, sans-io. Values in, values out, once a tick.

agent = Agent(config)
output = agent.tick(now_s, order, sightings, inbox, telemetry)
radio.send(output.frame); link.write(output.wire); observer.tell(output.status)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor
from typing import NamedTuple

from msgspec import structs

from comms.frames import Vec3
from comms.knowledge import Knowledge
from comms.messages import Frame, Sighting
from comms.signing import Signing
from comms.status import Activity, AgentStatus, HelpCallStatus
from swarm_agent.autopilot import Fly, Intent, Land, Phase, Pilot, PilotConfig, PilotState, Prepare, Return
from swarm_agent.bcmommt.belief import NOBODY, Table, begin_tick, cell_columns, cell_rows, forget, new_table, see
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Explore, Params
from swarm_agent.bcmommt.speech import answers_said, calls_said, hear, tags_said
from swarm_agent.bcmommt.step import Mind, new_mind
from swarm_agent.farewell import Farewell
from swarm_agent.insight import insight
from swarm_agent.mates import Mates
from swarm_agent.news import news
from swarm_agent.policies.choice import decide
from swarm_agent.reasons import Reasons
from swarm_agent.reserve import Battery, Reserve, ReserveConfig
from swarm_agent.safety import Guard, SafetyConfig

_NOWHERE = (0.0, 0.0, 0.0)
_HOMEWARD = frozenset({Phase.RETURN, Phase.LAND})
FRAMES_PER_S = 1000  # no agent sends more: a number that counts from the clock is above all that came before


class Order(NamedTuple):
    """What the mission wants of every agent in this tick.

    Attributes:
        mission_tick: ticks since the mission began, or None before it begins and after it ends.
        come_home: the mission is over: return and land. land: land on the spot, at once.
        hold: go on watching and speaking, but stay where it is.
        explain: somebody wants to know what every agent knows, and why it does what it does.
    """

    mission_tick: int | None = None
    come_home: bool = False
    land: bool = False
    hold: bool = False
    explain: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class AgentConfig:
    """Everything that does not change during a mission.

    Attributes:
        heading: unit vector (east, north) in which the search begins. ttl_s: how long its frames are worth hearing.
        radio_range_m: how far they should be heard.
    """

    uid: int
    seed: int
    params: Params
    n_agents: int
    n_targets: int
    heading: tuple[float, float]
    ttl_s: float
    radio_range_m: float
    pilot: PilotConfig
    safety: SafetyConfig
    reserve: ReserveConfig


class Output(NamedTuple):
    """What an agent does in a tick: says `frame` (None: silence), writes `wire` to its autopilot, shows `status`."""

    frame: Frame | None
    wire: bytes
    status: AgentStatus


class Agent:
    """Agent `uid` of a mission. It knows what it senses, what reaches its radio, and what its autopilot tells."""

    def __init__(self, config: AgentConfig, *, signing: Signing | None = None) -> None:
        """`signing`: of the link to its vehicle, if that is signed."""
        self._config = config
        self._signing = signing
        self._on_duty = False
        self._farewell: Farewell | None = None
        self._table, self._mind = self._innocence()
        self._wanted_m_s = 0.0, 0.0
        self._seq = 0
        self._told: AgentStatus | None = None
        self._guard = Guard(config.safety)
        self._reserve = Reserve(config.reserve)
        self._mates = self._new_mates()
        self.pilot = Pilot(config.pilot, signing=signing)

    @property
    def uid(self) -> int:
        """Its number, from 0."""
        return self._config.uid

    def begun_anew(self) -> Agent:
        """The same agent as it was before it had seen anything."""
        return Agent(self._config, signing=self._signing)

    def tick(
        self, now_s: float, order: Order, sightings: Sequence[Sighting], inbox: Sequence[Frame], telemetry: bytes
    ) -> Output:
        """One pass: take in, decide, speak, steer.

        Args:
            now_s: the mission clock. sightings: what the sensor sees now. inbox: the frames that arrived, by sender.
            telemetry: bytes from the autopilot, up to this instant.
        """
        pilot = self.pilot
        pilot.listen(now_s, telemetry)
        state = pilot.state
        self._guard.hear(now_s, inbox)
        spent = self._reserve.spent(now_s, Battery(state.battery, state.voltage_v, state.battery_low))
        come_home = order.come_home or order.land or spent
        frame: Frame | None = None
        intent: Intent
        on_duty = state.ready and not state.link_lost and order.mission_tick is not None and not come_home
        if on_duty and order.mission_tick is not None and state.position_m and state.velocity_m_s:
            self._mates.hear(now_s, state.position_m, inbox)
            self._perceive(now_s, state.position_m, sightings, inbox)
            intent = self._decide(now_s, order.mission_tick, state.position_m, state.velocity_m_s, hold=order.hold)
            frame = self._say(now_s, state.position_m, state.velocity_m_s)
        else:
            intent = Land() if order.land else Return() if come_home else Prepare()
            frame = self._take_leave(now_s, order, sightings, inbox, goes_home=come_home or state.phase in _HOMEWARD)
        self._on_duty = frame is not None and self._farewell is None
        wire = pilot.act(now_s, intent)
        return Output(frame, wire, self._tell(now_s, self._status(pilot.state, inbox), explain=order.explain))

    def _innocence(self) -> tuple[Table, Mind]:
        """What an agent knows and thinks before its mission."""
        config, p = self._config, self._config.params
        cells = cell_columns(p) * cell_rows(p) if p.explore == Explore.STALE_FIRST else 0
        return new_table(config.n_targets, config.n_agents, cells), new_mind(*config.heading)

    def _new_mates(self) -> Mates:
        return Mates(range_m=self._config.radio_range_m, ttl_s=self._config.ttl_s)

    def _tell(self, now_s: float, status: AgentStatus, *, explain: bool) -> AgentStatus:
        """The status with everything to be said in words: by the autopilot, the pilot and the algorithm."""
        x, y, _ = status.position_m or _NOWHERE
        reasons = Reasons(self._table, self._config.params, self._mind, self._config.uid, x, y, now_s)
        events = self.pilot.take_events() + self._guard.take_events() + self._reserve.take_events()
        events += self._mates.take_events()
        if self._farewell is not None:
            events += self._farewell.take_events()
        events += news(self._told, status, reasons)
        self._told = status
        if explain:
            knowledge = self._explain(reasons)
            return structs.replace(status, events=events, knowledge=knowledge)
        return structs.replace(status, events=events) if events else status

    def _explain(self, reasons: Reasons) -> Knowledge:
        mavlink = self.pilot.take_heard()
        if not self._on_duty:
            return Knowledge(mavlink=mavlink)
        return insight(reasons, wanted_m_s=self._wanted_m_s, mavlink=mavlink)

    def _perceive(
        self, now_s: float, me: tuple[float, float, float], sightings: Sequence[Sighting], inbox: Sequence[Frame]
    ) -> None:
        table = self._table
        begin_tick(table)
        forget(table, self._config.params, now_s)
        hear(table, self._config.params, inbox)
        for target, x, y in sightings:
            see(table, self._config.params, target, x, y, me[0], me[1], now_s)

    def _decide(self, now_s: float, mission_tick: int, me: Vec3, velocity_m_s: Vec3, *, hold: bool) -> Fly:
        config = self._config
        self._mind, east, north = decide(
            self._table, config.params, self._mind, config.uid, me[0], me[1], now_s, config.seed, mission_tick
        )
        self._wanted_m_s = (0.0, 0.0) if hold else (east, north)
        return Fly(self._guard.safe(now_s, me, velocity_m_s, self._wanted_m_s))

    def _take_leave(
        self, now_s: float, order: Order, sightings: Sequence[Sighting], inbox: Sequence[Frame], *, goes_home: bool
    ) -> Frame | None:
        """Who goes while the mission goes on calls for its targets; else, and at last, it forgets, and is silent."""
        if not (self._on_duty or self._farewell):
            return None
        state = self.pilot.state
        leaves = goes_home and order.mission_tick is not None and not (state.link_lost or state.landed)
        if leaves and state.position_m and state.velocity_m_s:
            self._perceive(now_s, state.position_m, sightings, inbox)
            if self._farewell is None:
                self._farewell = Farewell(self._table)
                self._mind = new_mind(*self._config.heading)
            self._farewell.tick(self._table, self._config.params, now_s)
            if not self._farewell.over:
                return self._say(now_s, state.position_m, state.velocity_m_s)
        # On the ground or in other hands it must not hold on to targets.
        self._table, self._mind = self._innocence()
        self._mates = self._new_mates()
        self._farewell = None
        return None

    def _say(
        self, now_s: float, position_m: tuple[float, float, float], velocity_m_s: tuple[float, float, float]
    ) -> Frame:
        table, params = self._table, self._config.params
        # Not from 1, or the frames of an agent that begins anew would be taken for replays of its earlier life.
        self._seq = self._seq + 1 if self._seq else floor(now_s * FRAMES_PER_S) + 1
        return Frame(
            self._config.uid,
            self._seq,
            now_s,
            self._config.ttl_s,
            position_m,
            velocity_m_s,
            tags_said(table),
            calls_said(table, params, now_s),
            answers_said(self._mind),
        )

    def _status(self, state: PilotState, inbox: Sequence[Frame]) -> AgentStatus:
        calls = self._calls()
        return AgentStatus(
            uid=self._config.uid,
            activity=self._activity(any(call.urgent for call in calls), state),
            position_m=state.position_m,
            velocity_m_s=state.velocity_m_s,
            heading_rad=state.heading_rad,
            battery=state.battery,
            tags=tuple([j for j in self._table.known if self._table.tagged[j]]),
            calls=calls,
            helping=None if self._mind.helping == NOBODY else self._mind.helping,
            mates=tuple([frame.src for frame in inbox]),
            flight_mode=state.flight_mode,
        )

    def _calls(self) -> tuple[HelpCallStatus, ...]:
        table, horizon_s = self._table, self._config.params.horizon_s
        return tuple(
            [
                HelpCallStatus(j, min(table.loss_in_s[j], horizon_s), table.loss_in_s[j] <= horizon_s)
                if table.tagged[j]
                else HelpCallStatus(j, 0.0)
                for j in table.known
                if table.calling[j]
            ]
        )

    def _activity(self, calling: bool, state: PilotState) -> Activity:
        if state.phase is Phase.DONE:
            return Activity.LANDED
        if state.phase is Phase.FAILED or state.link_lost:
            return Activity.LOST
        if state.phase in (Phase.RETURN, Phase.LAND):
            return Activity.RETURNING
        if state.phase is Phase.TAKEN_OVER:
            return Activity.TAKEN_OVER
        if not self._on_duty:
            return Activity.PREPARING
        if self._mind.mode is Mode.FOLLOW:
            return Activity.CALLING if calling else Activity.FOLLOW
        return Activity.HELPING if self._mind.mode is Mode.HELP else Activity.EXPLORE
