"""What the autopilot reports: one builder per MAVLink message, and the table of them by message id.

A builder returns None when there is nothing to report yet. Every field is clamped to its wire type. `state` says what
any autopilot does, `motion` where it believes to be, `sensed` what its sensors read; what a flavor says in its own way,
and its whole table, is in the flavor's own `telemetry`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from vehicle_sim.autopilot.telemetry import motion, sensed, state

Builder = Callable[[Any], Any]  # from an autopilot of the flavor whose table it is in

SHARED: dict[int, Builder] = {
    2: state.system_time,
    24: sensed.gps_raw_int,
    26: sensed.scaled_imu,
    27: sensed.raw_imu,
    29: sensed.scaled_pressure,
    30: motion.attitude,
    31: motion.attitude_quaternion,
    32: motion.local_position_ned,
    33: motion.global_position_int,
    36: state.servo_output_raw,
    49: motion.gps_global_origin,
    65: state.rc_channels,
    74: motion.vfr_hud,
    85: motion.position_target_local_ned,
    116: sensed.scaled_imu2,
    125: state.power_status,
    152: state.meminfo,
    163: sensed.ahrs,
    164: sensed.simstate,
    168: sensed.wind,
    178: sensed.ahrs2,
    193: sensed.ekf_status_report,
    241: sensed.vibration,
    242: motion.home_position,
    245: state.extended_sys_state,
}
