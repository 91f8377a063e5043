"""The scripted peer as a PX4: modes in two bytes, takeoff above the sea, OFFBOARD only while setpoints come.

From PX4's sources (px4_custom_mode.h, Commander, OffboardChecks) and design/mavlink.md, not from a recording.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.mavlink import Message
from swarm_agent.autopilot.flavors import PX4_MODES
from tests.swarm_agent.scripted_copter import ScriptedCopter

HOLD, TAKEOFF, OFFBOARD, RTL, LAND = (
    PX4_MODES[name].custom_mode for name in ("HOLD", "TAKEOFF", "OFFBOARD", "RTL", "LAND")
)
SETPOINT_LIVES_S = 1.0  # COM_OF_LOSS_T


@dataclass
class ScriptedPx4(ScriptedCopter):
    """As far as the conversation goes."""

    autopilot: int = dialect.MAV_AUTOPILOT_PX4
    parameters: dict[str, float] = field(default_factory=lambda: {"RTL_RETURN_ALT": 60.0})
    mode: int = PX4_MODES["MANUAL"].custom_mode
    setpoint_at_s: float = float("-inf")
    now_s: float = 0.0
    rejected: int = 0

    guided, climbing, homing, landing = OFFBOARD, TAKEOFF, RTL, LAND

    def tick(self, now_s: float, wire_in: bytes, *, dt_s: float = 0.1) -> bytes:
        self.now_s = now_s
        if self.mode == OFFBOARD and self.armed and not self._fresh:
            self.mode = HOLD
        if self.mode == TAKEOFF and self.climb_to_m is not None and -self.local_ned_m[2] >= self.climb_to_m:
            self.mode, self.climb_to_m = HOLD, None
        return super().tick(now_s, wire_in, dt_s=dt_s)

    @property
    def may_arm(self) -> bool:
        """Manual modes want a stick, which it has not."""
        return self.mode == HOLD

    @property
    def _fresh(self) -> bool:
        return self.now_s - self.setpoint_at_s <= SETPOINT_LIVES_S

    def _hear(self, message: Message) -> None:
        if isinstance(message, dialect.MAVLink_set_position_target_local_ned_message):
            self.setpoint_at_s = self.now_s
        super()._hear(message)

    def _obey(self, message: Message) -> int:
        if message.command == dialect.MAV_CMD_DO_SET_MODE:
            mode = int(message.param2) << 16 | int(message.param3) << 24
            if mode == OFFBOARD and not self._fresh:
                self.rejected += 1
                return int(dialect.MAV_RESULT_TEMPORARILY_REJECTED)
            self.mode, self.climb_to_m, self.velocity_ned_m_s = mode, None, (0.0, 0.0, 0.0)
            return int(dialect.MAV_RESULT_ACCEPTED)
        if message.command == dialect.MAV_CMD_NAV_TAKEOFF:
            if not (self.armed and self.landed):
                return int(dialect.MAV_RESULT_TEMPORARILY_REJECTED)
            self.mode, self.climb_to_m = TAKEOFF, message.param7 - self.origin.altitude_m
            return int(dialect.MAV_RESULT_ACCEPTED)
        return super()._obey(message)
