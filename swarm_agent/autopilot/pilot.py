"""The pilot of one vehicle, sans-io: takes it from its first heartbeat to its layer, flies it, and brings it back."""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.mavlink import Endpoint, Message
from comms.signing import Signing
from comms.status import Event, Level
from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.config import PilotConfig
from swarm_agent.autopilot.ending import Failed
from swarm_agent.autopilot.ground import Connect, Preflight
from swarm_agent.autopilot.intent import Intent
from swarm_agent.autopilot.requests import AUTOPILOT_COMPONENT_ID
from swarm_agent.autopilot.stage import Stage
from swarm_agent.autopilot.state import Phase, PilotState
from swarm_agent.autopilot.streams import Streams

HEARTBEAT_S = 1.0
CLOCK_SLACK_S = 1e-6  # ticks of 0.1 s do not add up to 1 s exactly
EVERYBODY = 0
MOST_RESTARTS = 3
ON_GROUND = frozenset({Phase.PREFLIGHT, Phase.ARM})
UNTOUCHED = frozenset({Phase.CONNECT, Phase.DONE, Phase.FAILED})  # by a restart
NO_AUTOPILOT: int = dialect.MAV_AUTOPILOT_INVALID

REPLIES = frozenset({
    dialect.MAVLink_command_ack_message,
    dialect.MAVLink_param_value_message,
    dialect.MAVLink_param_error_message,
})  # fmt: skip


class Pilot:
    """One vehicle's pilot.

    Attributes:
        config: as given.
        endpoint: the link's counters: `sent`, `received`, `bad`, `dropped`.
    """

    def __init__(self, config: PilotConfig, *, signing: Signing | None = None) -> None:
        """`signing`: of this link, if it is signed: then nothing else is heard on it."""
        self.config = config
        self.endpoint = Endpoint(
            system_id=config.ground_system_id, component_id=config.ground_component_id, signing=signing
        )
        self._cockpit = Cockpit(config, self.endpoint)
        self._streams = Streams()
        self._stage: Stage = Connect()
        self._heartbeat_due_s = float("-inf")
        self._link_lost = False
        self._restarts = 0
        self._heard: dict[type[Message], Message] = {}

    def tick(self, now_s: float, wire_in: bytes, intent: Intent) -> bytes:
        """`listen`, then `act`: for whoever knows what it wants without looking at the vehicle first."""
        self.listen(now_s, wire_in)
        return self.act(now_s, intent)

    def listen(self, now_s: float, wire_in: bytes) -> None:
        """Take in what the vehicle has sent since the last call; `state` is of now. Never raises on `wire_in`.

        Args:
            now_s: the mission clock; it never falls back.
            wire_in: raw bytes from the link, whole frames or not.
        """
        self._cockpit.begin_tick()
        self._hear(wire_in, now_s)
        self._watch_link(now_s)
        self._watch_restarts(now_s)

    def act(self, now_s: float, intent: Intent) -> bytes:
        """What to send to the vehicle now, given what the agent wants; once after each `listen`."""
        cockpit = self._cockpit
        self._beat(now_s)
        if cockpit.telemetry.autopilot is not None:
            self._streams.tick(cockpit, now_s)
        self._enter(self._stage.tick(cockpit, now_s, intent))
        return self.endpoint.take()

    @property
    def state(self) -> PilotState:
        """The vehicle and the flight as of now."""
        telemetry, stage = self._cockpit.telemetry, self._stage
        return PilotState(
            phase=stage.phase,
            ready=stage.ready,
            position_m=telemetry.position_m,
            velocity_m_s=telemetry.velocity_m_s,
            heading_rad=telemetry.heading_rad,
            battery=telemetry.battery,
            voltage_v=telemetry.voltage_v,
            battery_low=telemetry.battery_low,
            armed=telemetry.armed,
            flight_mode=self._cockpit.mode_name,
            landed=telemetry.landed,
            link_lost=self._link_lost,
            failure=stage.failure,
        )

    @property
    def ignored(self) -> int:
        """Messages that came in whole but with numbers no vehicle can mean."""
        return self._cockpit.telemetry.ignored

    def take_events(self) -> tuple[Event, ...]:
        """What the autopilot said and what went wrong, since the last call."""
        return self._cockpit.take_events()

    def take_heard(self) -> tuple[bytes, ...]:
        """Of each kind of message that the vehicle has sent since the last call, the newest frame."""
        frames = tuple([bytes(message.get_msgbuf()) for message in self._heard.values()])
        self._heard.clear()
        return frames

    def _hear(self, wire_in: bytes, now_s: float) -> None:
        """Sort the vehicle's messages; those of other systems and of its other components are not for us."""
        cockpit = self._cockpit
        dropped = self.endpoint.dropped
        messages = self.endpoint.receive(wire_in)
        if self.endpoint.dropped > dropped:
            cockpit.say(Level.WARNING, f"{len(wire_in)} bytes in one tick: not all of it is heard")
        for message in messages:
            if message.get_srcComponent() != AUTOPILOT_COMPONENT_ID:
                continue
            if cockpit.system_id is None:
                self._meet(message)
            if message.get_srcSystem() != cockpit.system_id:
                continue
            kind = type(message)
            self._heard[kind] = message
            if kind in REPLIES:
                if self._for_us(message):
                    cockpit.replies.append(message)
            elif kind is dialect.MAVLink_statustext_message:
                cockpit.hear_text(message, now_s)
            else:
                cockpit.telemetry.hear(message, now_s)

    def _meet(self, message: Message) -> None:
        """The first autopilot heard is the vehicle. Ground stations, which have the same component id, are none."""
        if isinstance(message, dialect.MAVLink_heartbeat_message) and message.autopilot != NO_AUTOPILOT:
            self._cockpit.system_id = message.get_srcSystem()

    def _for_us(self, message: Message) -> bool:
        """Parameters are for all; an acknowledgment may be a ground station's on the same vehicle."""
        if not isinstance(message, dialect.MAVLink_command_ack_message):
            return True
        systems = (EVERYBODY, self.config.ground_system_id)
        return message.target_system in systems and message.target_component in (
            EVERYBODY,
            self.config.ground_component_id,
        )

    def _beat(self, now_s: float) -> None:
        """Our own HEARTBEAT, as a ground station: the vehicle's ground-station failsafe watches it."""
        if now_s < self._heartbeat_due_s:
            return
        self._heartbeat_due_s = now_s + HEARTBEAT_S - CLOCK_SLACK_S
        self._cockpit.send(
            dialect.MAVLink_heartbeat_message(
                dialect.MAV_TYPE_GCS, dialect.MAV_AUTOPILOT_INVALID, 0, 0, dialect.MAV_STATE_ACTIVE, 3
            )
        )

    def _enter(self, stage: Stage) -> None:
        """Go on with this stage; that there is nothing to go on with is told."""
        if stage.failure and not self._stage.failure:
            self._cockpit.say(Level.ERROR, f"given up: {stage.failure}")
        self._stage = stage

    def _watch_restarts(self, now_s: float) -> None:
        """A restarted vehicle is checked anew, on the ground or in the air; one that restarts over and over is not."""
        restarts, phase = self._cockpit.telemetry.restarts, self._stage.phase
        if restarts == self._restarts:
            return
        self._restarts = restarts
        if phase in UNTOUCHED:
            return
        level = Level.WARNING if phase in ON_GROUND else Level.ERROR
        self._cockpit.say(level, "the autopilot has restarted: it is checked anew")
        if restarts > MOST_RESTARTS:
            self._enter(Failed(f"the autopilot has restarted {restarts} times", bring_down=True))
        else:
            self._enter(Preflight(since_s=now_s))

    def _watch_link(self, now_s: float) -> None:
        heard_at_s = self._cockpit.telemetry.heartbeat_at_s
        if heard_at_s is None or (now_s - heard_at_s > self.config.link_lost_s) == self._link_lost:
            return
        self._link_lost = not self._link_lost
        if self._link_lost:
            self._cockpit.say(Level.ERROR, f"link lost: no heartbeat for {self.config.link_lost_s:g} s")
        else:
            self._cockpit.say(Level.INFO, "the link is back")
