"""What a PX4 takes in without an answer: any ground station's sign of life, setpoints, any joystick."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.px4.commander import Commander
from vehicle_sim.autopilot.px4.setpoints import (
    Trajectory,
    global_trajectory,
    local_trajectory,
)
from vehicle_sim.autopilot.setpoints import attitude_target
from vehicle_sim.autopilot.severity import CRITICAL
from vehicle_sim.autopilot.sticks import manual, overridden

GROUND_STATION = 6  # MAV_TYPE_GCS
LEAST_HOVER, MOST_HOVER = 0.1, 0.9  # share of full thrust


def heartbeat(pilot: Commander, message: Any) -> None:
    if message.type == GROUND_STATION:
        pilot.hear_gcs()


def local_target(pilot: Commander, message: Any) -> None:
    trajectory = local_trajectory(message, yaw_rad=pilot.estimate.yaw_rad)
    _take(pilot, trajectory, message.coordinate_frame)


def global_target(pilot: Commander, message: Any) -> None:
    trajectory = global_trajectory(message, origin=pilot.origin, home=pilot.home)
    _take(pilot, trajectory, message.coordinate_frame)


def _take(pilot: Commander, trajectory: Trajectory | None, frame: int) -> None:
    """A frame that it does not take is said; a setpoint with nothing in it is none."""
    if trajectory is None:
        pilot.say(CRITICAL, f"Setpoint coordinate frame {frame} unsupported")
    elif trajectory.says_something:
        pilot.hear_setpoint(trajectory)


def attitude(pilot: Commander, message: Any) -> None:
    hover = max(LEAST_HOVER, min(MOST_HOVER, pilot.parameters["MPC_THR_HOVER"]))
    pilot.hear_setpoint(attitude_target(message, hover=hover))


def rc_override(pilot: Commander, message: Any) -> None:
    pilot.take_sticks(overridden(pilot.steering.sticks, message))


def manual_control(pilot: Commander, message: Any) -> None:
    if message.target == pilot.system_id:
        pilot.take_sticks(manual(pilot.steering.sticks, message))


HEARING: dict[int, Callable[[Commander, Any], None]] = {
    dialect.MAVLINK_MSG_ID_HEARTBEAT: heartbeat,
    dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED: local_target,
    dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT: global_target,
    dialect.MAVLINK_MSG_ID_SET_ATTITUDE_TARGET: attitude,
    dialect.MAVLINK_MSG_ID_RC_CHANNELS_OVERRIDE: rc_override,
    dialect.MAVLINK_MSG_ID_MANUAL_CONTROL: manual_control,
}
