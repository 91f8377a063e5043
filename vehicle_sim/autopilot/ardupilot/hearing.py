"""What an ArduCopter takes in without an answer: a ground station's sign of life, setpoints, sticks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.ardupilot.copter import Copter
from vehicle_sim.autopilot.setpoints import attitude_target, global_setpoint, local_setpoint
from vehicle_sim.autopilot.sticks import Sticks, manual, overridden


def heartbeat(pilot: Copter, message: Any) -> None:
    """Only of the ground station of SYSID_MYGCS."""
    if _is_ground_station(pilot, message):
        pilot.hear_gcs()


def local_target(pilot: Copter, message: Any) -> None:
    belief = pilot.estimate
    position = (belief.north_m, belief.east_m, belief.down_m)
    pilot.follow(local_setpoint(message, position_ned_m=position, yaw_rad=belief.yaw_rad))


def global_target(pilot: Copter, message: Any) -> None:
    pilot.follow(global_setpoint(message, origin=pilot.origin, home=pilot.home))


def attitude(pilot: Copter, message: Any) -> None:
    target = attitude_target(message)
    if target is not None:
        pilot.guidance.lean(target, pilot.now_s)


def rc_override(pilot: Copter, message: Any) -> None:
    _take_sticks(pilot, message, overridden)


def manual_control(pilot: Copter, message: Any) -> None:
    if message.target == pilot.system_id:
        _take_sticks(pilot, message, manual)


def _take_sticks(pilot: Copter, message: Any, read: Callable[[Sticks, Any], Sticks]) -> None:
    """Only the ground station of SYSID_MYGCS is a pilot, as on a real ArduCopter."""
    if _is_ground_station(pilot, message):
        pilot.take_sticks(read(pilot.steering.sticks, message))


def _is_ground_station(pilot: Copter, message: Any) -> bool:
    return bool(message.get_srcSystem() == pilot.parameters["SYSID_MYGCS"])


HEARING: dict[int, Callable[[Copter, Any], None]] = {
    dialect.MAVLINK_MSG_ID_HEARTBEAT: heartbeat,
    dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED: local_target,
    dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT: global_target,
    dialect.MAVLINK_MSG_ID_SET_ATTITUDE_TARGET: attitude,
    dialect.MAVLINK_MSG_ID_RC_CHANNELS_OVERRIDE: rc_override,
    dialect.MAVLINK_MSG_ID_MANUAL_CONTROL: manual_control,
}
