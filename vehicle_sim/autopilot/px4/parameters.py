"""The parameters of a PX4, whose table is `parameters.csv` beside this file, and what they mean to shared parts."""

from __future__ import annotations

from vehicle_sim.autopilot.ardupilot.parameters import TABLE
from vehicle_sim.autopilot.parameters import Alias, Catalog, read_table, surroundings
from vehicle_sim.vehicle import VehicleConfig

ROWS = read_table(__package__ or "")
METERS_PER_HPA = -8.43  # near sea level: more pressure is less height
COMPASS_X_MGAUSS, COMPASS_Y_MGAUSS = 5.0, 13.0  # the field that the calibration has taken away

# What the shared parts read by an ArduCopter's name, and what PX4 calls it.
SHARED: dict[str, Alias] = {
    "ANGLE_MAX": Alias("MPC_TILTMAX_AIR", 100.0),
    "EK3_ALT_M_NSE": Alias("EKF2_BARO_NOISE"),
    "EK3_HGT_I_GATE": Alias("EKF2_BARO_GATE", 100.0),
    "EK3_POSNE_M_NSE": Alias("EKF2_GPS_P_NOISE"),
    "EK3_POS_I_GATE": Alias("EKF2_GPS_P_GATE", 100.0),
    "EK3_VELNE_M_NSE": Alias("EKF2_GPS_V_NOISE"),
    "EK3_VEL_I_GATE": Alias("EKF2_GPS_V_GATE", 100.0),
    "EK3_YAW_I_GATE": Alias("EKF2_HDG_GATE", 100.0),
    "EK3_YAW_M_NSE": Alias("EKF2_HEAD_NOISE"),
    "LAND_ALT_LOW": Alias("MPC_LAND_ALT2", 100.0),
    "LAND_SPEED": Alias("MPC_LAND_SPEED", 100.0),
    "LOIT_SPEED": Alias("MPC_VEL_MANUAL", 100.0),
    "SIM_BARO_GLITCH": Alias("SIM_BARO_OFF_P", METERS_PER_HPA),
    "SIM_GPS_NUMSATS": Alias("SIM_GPS_USED"),
    "SIM_MAG1_OFS_X": Alias("SIM_MAG_OFFSET_X", 1000.0, COMPASS_X_MGAUSS),
    "SIM_MAG1_OFS_Y": Alias("SIM_MAG_OFFSET_Y", 1000.0, COMPASS_Y_MGAUSS),
    "WPNAV_ACCEL": Alias("MPC_ACC_HOR", 100.0),
    "WPNAV_RADIUS": Alias("NAV_ACC_RAD", 100.0),
    "WPNAV_SPEED": Alias("MPC_XY_VEL_MAX", 100.0),
    "WPNAV_SPEED_DN": Alias("MPC_Z_VEL_MAX_DN", 100.0),
    "WPNAV_SPEED_UP": Alias("MPC_Z_VEL_MAX_UP", 100.0),
}

# What they read and PX4 has no word for: as an ArduCopter has it, but for these.
PECULIAR: dict[str, float] = {
    "AUTO_OPTIONS": 3.0,  # missions take off by themselves
    "COMPASS_OFS_X": COMPASS_X_MGAUSS,
    "COMPASS_OFS_Y": COMPASS_Y_MGAUSS,
    "MIS_RESTART": 0.0,
    "RALLY_LIMIT_KM": 0.0,
}
COMMON = ("CIRCLE_R", "LAND_SPEED_HIGH", "RALLY_INCL_HOME", "SIM_", "WP_YAW_BEHAVIOR")  # the beginnings of names
GIVEN = {row.name: row.default for row in TABLE if row.name.startswith(COMMON)} | PECULIAR

CATALOG = Catalog(ROWS, shared=SHARED, given=GIVEN)


def px4_values(config: VehicleConfig, system_id: int) -> dict[str, float]:
    """What differs from the defaults in a vehicle of this kind."""
    limits = config.limits
    return {
        "MAV_SYS_ID": float(system_id),
        "BAT1_CAPACITY": config.battery.capacity_mah,
        "MPC_ACC_HOR": limits.acceleration_m_s2,
        "MPC_TILTMAX_AIR": limits.tilt_deg,
        "MPC_XY_VEL_MAX": limits.speed_m_s,
        "MPC_XY_CRUISE": min(5.0, limits.speed_m_s),
        "MPC_VEL_MANUAL": min(10.0, limits.speed_m_s),
        "MPC_Z_VEL_MAX_UP": limits.climb_m_s,
        "MPC_Z_V_AUTO_UP": min(3.0, limits.climb_m_s),
        "MPC_TKO_SPEED": min(1.5, limits.climb_m_s),
        "MPC_Z_VEL_MAX_DN": limits.descent_m_s,
        "MPC_Z_V_AUTO_DN": min(1.5, limits.descent_m_s),
        **surroundings(config),
    }
