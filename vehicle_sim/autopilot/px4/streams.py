"""What a PX4 sends unasked: the rates of its normal mode, as far as this vehicle has the message."""

from __future__ import annotations

from vehicle_sim.autopilot.streams import HEARTBEAT_ID, HEARTBEAT_PERIOD_S

# Message id -> Hz (Mavlink::configure_streams_to_default; MISSION_CURRENT is the mission manager's).
RATES_HZ: dict[int, float] = {
    1: 1.0,  # SYS_STATUS
    24: 1.0,  # GPS_RAW_INT
    29: 1.0,  # SCALED_PRESSURE
    30: 15.0,  # ATTITUDE
    31: 10.0,  # ATTITUDE_QUATERNION
    32: 1.0,  # LOCAL_POSITION_NED
    33: 5.0,  # GLOBAL_POSITION_INT
    36: 1.0,  # SERVO_OUTPUT_RAW
    42: 1.0,  # MISSION_CURRENT
    49: 1.0,  # GPS_GLOBAL_ORIGIN
    62: 1.0,  # NAV_CONTROLLER_OUTPUT
    65: 5.0,  # RC_CHANNELS
    74: 4.0,  # VFR_HUD
    83: 2.0,  # ATTITUDE_TARGET
    85: 1.5,  # POSITION_TARGET_LOCAL_NED
    87: 1.0,  # POSITION_TARGET_GLOBAL_INT
    141: 1.0,  # ALTITUDE
    147: 0.5,  # BATTERY_STATUS
    230: 0.5,  # ESTIMATOR_STATUS
    231: 0.5,  # WIND_COV
    241: 0.1,  # VIBRATION
    242: 0.5,  # HOME_POSITION
    245: 1.0,  # EXTENDED_SYS_STATE
}
UNASKED_S: dict[int, float] = {HEARTBEAT_ID: HEARTBEAT_PERIOD_S} | {
    message_id: 1.0 / rate_hz for message_id, rate_hz in RATES_HZ.items()
}
