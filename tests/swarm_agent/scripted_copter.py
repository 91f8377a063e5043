"""A peer for pilot tests: answers as the recorded ArduCopter 4.5.5 SITL did, except where a test scripts it otherwise.

It moves as points do (setpoints are followed at once), because what is tested is the conversation.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint, Vec3, geo_from_enu
from comms.mavlink import Endpoint, Message

HOME = GeoPoint(47.397742, 8.545594, 488.1)
SILENCE = -1
GUIDED, RTL, LAND = 4, 6, 9
PREARM_BIT = 0x10000000
HEALTH = 0x4771FC2F  # recorded while the pre-arm checks failed


@dataclass
class ScriptedCopter:
    """One vehicle, standing `offset_m` (ENU) from the mission's home.

    Attributes:
        script: command -> the results it gives first, before it answers as usual (`SILENCE`: none at all).
        words: command -> the text that follows each scripted refusal, a tick later.
        heard: every message received, in order.
    """

    offset_m: Vec3 = (0.0, 0.0, 0.0)
    system_id: int = 4
    autopilot: int = dialect.MAV_AUTOPILOT_ARDUPILOTMEGA
    ready_at_s: float = 0.0
    script: dict[int, list[int]] = field(default_factory=dict)
    words: dict[int, str] = field(default_factory=dict)
    parameters: dict[str, float] = field(default_factory=lambda: {"RTL_ALT": 1500.0})
    quiet: bool = False
    mode: int = 0
    armed: bool = False
    local_ned_m: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    velocity_ned_m_s: Vec3 = (0.0, 0.0, 0.0)
    heard: list[Message] = field(default_factory=list)

    guided, climbing, homing, landing = GUIDED, GUIDED, RTL, LAND

    def __post_init__(self) -> None:
        self.endpoint = Endpoint(system_id=self.system_id)
        self.climb_to_m: float | None = None
        self.streams: set[int] = set()
        self.origin = geo_from_enu(HOME, self.offset_m)
        self._later: list[Message] = []
        self._ticks = 0

    @property
    def may_arm(self) -> bool:
        """Whether its mode is one to arm in."""
        return True

    @property
    def landed(self) -> bool:
        return self.local_ned_m[2] > -0.05

    def commands(self, command: int) -> list[Message]:
        """The COMMAND_LONGs of this kind heard so far."""
        return [m for m in self.of(dialect.MAVLink_command_long_message) if m.command == command]

    def of(self, kind: type) -> list[Message]:
        return [message for message in self.heard if isinstance(message, kind)]

    def say(self, severity: int, text: str) -> None:
        self.endpoint.send(dialect.MAVLink_statustext_message(severity, text.encode()))

    def tick(self, now_s: float, wire_in: bytes, *, dt_s: float = 0.1) -> bytes:
        self._ready = now_s >= self.ready_at_s
        for message in self._later:
            self.endpoint.send(message)
        self._later.clear()
        for message in self.endpoint.receive(wire_in):
            self.heard.append(message)
            self._hear(message)
        self._move(dt_s)
        if not self.quiet:
            self._tell(now_s)
        self._ticks += 1
        return self.endpoint.take()

    def _hear(self, message: Message) -> None:
        if isinstance(message, dialect.MAVLink_command_long_message):
            self._command(message)
        elif isinstance(message, dialect.MAVLink_param_set_message) and message.param_id in self.parameters:
            self.parameters[message.param_id] = message.param_value
            name = message.param_id.encode()
            self.endpoint.send(dialect.MAVLink_param_value_message(name, message.param_value, 6, 1364, 0xFFFF))
        elif isinstance(message, dialect.MAVLink_set_position_target_local_ned_message):
            if self.mode == self.guided and not self.landed:
                self.velocity_ned_m_s, self.climb_to_m = (message.vx, message.vy, message.vz), None
        elif isinstance(message, dialect.MAVLink_request_data_stream_message):
            self.streams |= {dialect.MAVLINK_MSG_ID_ATTITUDE, dialect.MAVLINK_MSG_ID_LOCAL_POSITION_NED}

    def _command(self, message: Message) -> None:
        command = message.command
        scripted = self.script.get(command)
        result = scripted.pop(0) if scripted else self._obey(message)
        if result == SILENCE:
            return
        self.endpoint.send(
            dialect.MAVLink_command_ack_message(
                command, result, 0, 0, message.get_srcSystem(), message.get_srcComponent()
            )
        )
        if result != dialect.MAV_RESULT_ACCEPTED and command in self.words:
            self._later.append(dialect.MAVLink_statustext_message(2, self.words[command].encode()))

    def _obey(self, message: Message) -> int:
        first, second = message.param1, message.param2
        if message.command == dialect.MAV_CMD_SET_MESSAGE_INTERVAL:
            self.streams.add(int(first))
        elif message.command == dialect.MAV_CMD_REQUEST_MESSAGE:
            if self._ready:
                where = (round(self.origin.latitude_deg * 1e7), round(self.origin.longitude_deg * 1e7))
                height = round(self.origin.altitude_m * 1e3)
                self.endpoint.send(dialect.MAVLink_gps_global_origin_message(*where, height, 0))
        elif message.command == dialect.MAV_CMD_DO_SET_MODE:
            self.mode, self.climb_to_m, self.velocity_ned_m_s = int(second), None, (0.0, 0.0, 0.0)
        elif message.command == dialect.MAV_CMD_COMPONENT_ARM_DISARM:
            if (first == 1.0 and not self._ready) or (first == 0.0 and not self.landed):
                return int(dialect.MAV_RESULT_FAILED)
            self.armed = first == 1.0
        elif message.command == dialect.MAV_CMD_NAV_TAKEOFF:
            if not (self.armed and self.mode == GUIDED and self.landed):
                return int(dialect.MAV_RESULT_FAILED)
            self.climb_to_m = message.param7
        else:
            return int(dialect.MAV_RESULT_UNSUPPORTED)
        return int(dialect.MAV_RESULT_ACCEPTED)

    def _move(self, dt_s: float) -> None:
        place = self.local_ned_m
        if self.mode not in (self.guided, self.climbing):
            self.climb_to_m, self.velocity_ned_m_s = None, (0.0, 0.0, 0.0)
        if self.armed and self.mode in (self.homing, self.landing):
            self._descend(dt_s)
        elif self.climb_to_m is not None:
            place[2] = max(place[2] - 2.5 * dt_s, -self.climb_to_m)
            self.velocity_ned_m_s = (0.0, 0.0, -2.5 if place[2] > -self.climb_to_m else 0.0)
        elif self.armed and not self.landed:
            for axis, speed in enumerate(self.velocity_ned_m_s):
                place[axis] += speed * dt_s

    def _descend(self, dt_s: float) -> None:
        place, away_m = self.local_ned_m, hypot(self.local_ned_m[0], self.local_ned_m[1])
        if self.mode == self.homing and away_m > 0.5:
            shrink = max(0.0, 1.0 - 5.0 * dt_s / away_m)
            place[0], place[1] = place[0] * shrink, place[1] * shrink
            return
        place[2] = min(place[2] + 1.5 * dt_s, 0.0)
        if self.landed:
            self.armed = False

    def _tell(self, now_s: float) -> None:
        boot_ms = round(now_s * 1000.0)
        if self._ticks % 10 == 0:
            flags = 81 | (8 if self.mode == self.guided else 0) | (128 if self.armed else 0)
            status = 4 if self.armed and not self.landed else 3
            self.endpoint.send(dialect.MAVLink_heartbeat_message(2, self.autopilot, flags, self.mode, status, 3))
            self._tell_slow(boot_ms)
        if dialect.MAVLINK_MSG_ID_ATTITUDE in self.streams:
            self.endpoint.send(dialect.MAVLink_attitude_message(boot_ms, 0.0, 0.0, -1.5, 0.0, 0.0, 0.0))
        if dialect.MAVLINK_MSG_ID_LOCAL_POSITION_NED in self.streams and self._ready:
            numbers = (*self.local_ned_m, *self.velocity_ned_m_s)
            self.endpoint.send(dialect.MAVLink_local_position_ned_message(boot_ms, *numbers))

    def _tell_slow(self, boot_ms: int) -> None:
        if dialect.MAVLINK_MSG_ID_SYS_STATUS in self.streams:
            health = HEALTH | (PREARM_BIT if self._ready and self.may_arm else 0)
            battery = (12600, 0, 83)
            self.endpoint.send(
                dialect.MAVLink_sys_status_message(health, health, health, 0, *battery, 0, 0, 0, 0, 0, 0)
            )
        if dialect.MAVLINK_MSG_ID_EXTENDED_SYS_STATE in self.streams:
            self.endpoint.send(dialect.MAVLink_extended_sys_state_message(3, 1 if self.landed else 2))
        if dialect.MAVLINK_MSG_ID_EKF_STATUS_REPORT in self.streams:
            flags = 831 if self._ready else 167
            self.endpoint.send(dialect.MAVLink_ekf_status_report_message(flags, 0.0, 0.0, 0.0, 0.0, 0.0))
