"""What REQUEST_DATA_STREAM switches in an ArduCopter."""

from __future__ import annotations

from vehicle_sim.autopilot.streams import Group

# MAV_DATA_STREAM -> its group.
GROUPS: dict[int, Group] = {
    1: Group("SR0_RAW_SENS", (27, 116, 29)),  # RAW_IMU, SCALED_IMU2, SCALED_PRESSURE
    2: Group("SR0_EXT_STAT", (1, 125, 152, 42, 24, 62, 162, 87)),  # SYS_STATUS, ... GPS_RAW_INT, ... FENCE_STATUS ...
    3: Group("SR0_RC_CHAN", (36, 65)),  # SERVO_OUTPUT_RAW, RC_CHANNELS
    6: Group("SR0_POSITION", (33, 32)),  # GLOBAL_POSITION_INT, LOCAL_POSITION_NED
    10: Group("SR0_EXTRA1", (30, 164, 178)),  # ATTITUDE, SIMSTATE, AHRS2
    11: Group("SR0_EXTRA2", (74,)),  # VFR_HUD
    12: Group("SR0_EXTRA3", (163, 168, 2, 147, 193, 241)),  # AHRS, WIND, SYSTEM_TIME, BATTERY_STATUS, EKF, VIBRATION
}
