"""Velocity setpoints: the agent's horizontal wish, the layer held vertically, and only small numbers."""

from __future__ import annotations

from math import hypot, isfinite

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import Vec3
from comms.mavlink import Message
from swarm_agent.autopilot.requests import AUTOPILOT_COMPONENT_ID

VELOCITY_ONLY = 0xDC7  # ignore position, acceleration, yaw and yaw rate
# A vehicle follows its climb setpoint about 0.8 s late (recorded ArduCopter 4.5.5 SITL); with that lag this gain is
# damped by 0.8.
HOLD_GAIN_PER_S = 0.5
ROUNDING = 1e-9  # a velocity cut to the limit by others is not cut again


def limit_speed(velocity_m_s: tuple[float, float], *, max_speed_m_s: float) -> tuple[float, float] | None:
    """The velocity, shortened to `max_speed_m_s` if it is faster; None if it holds no number."""
    x, y = velocity_m_s
    speed = hypot(x, y)
    if speed <= max_speed_m_s * (1.0 + ROUNDING):
        return velocity_m_s
    if not isfinite(speed):
        return None
    scale = max_speed_m_s / speed
    return (x * scale, y * scale)


def hold_layer(up_m: float, *, layer_m: float, max_climb_m_s: float) -> float:
    """The climb rate (m/s, up) that brings a vehicle at `up_m` to its layer: proportional, clamped both ways."""
    return min(max(HOLD_GAIN_PER_S * (layer_m - up_m), -max_climb_m_s), max_climb_m_s)


def velocity_setpoint(velocity_enu_m_s: Vec3, *, system_id: int, now_s: float) -> Message:
    """SET_POSITION_TARGET_LOCAL_NED for this ENU velocity; `now_s` is its time stamp."""
    east, north, up = velocity_enu_m_s
    return dialect.MAVLink_set_position_target_local_ned_message(
        int(now_s * 1000.0) & 0xFFFFFFFF, system_id, AUTOPILOT_COMPONENT_ID, dialect.MAV_FRAME_LOCAL_NED, VELOCITY_ONLY,
        0.0, 0.0, 0.0, north, east, -up, 0.0, 0.0, 0.0, 0.0, 0.0,
    )  # fmt: skip
