"""The parameters of an ArduCopter, whose table and manual is `parameters.csv` beside this file.

Types, defaults and names are those of a recorded ArduCopter 4.5.5 SITL; names of 4.7 are understood beside them. Rows
whose status is `acts` do something here; those `stored` are kept for ground stations.
"""

from __future__ import annotations

from vehicle_sim.autopilot.parameters import Alias, Catalog, read_table, surroundings
from vehicle_sim.vehicle import VehicleConfig

LOW_SHARE = 10.5 / 12.6  # BATT_LOW_VOLT of a battery: as low as the default is for the default battery

TABLE = read_table(__package__ or "")
INDEX: dict[str, int] = {row.name: index for index, row in enumerate(TABLE)}

ALIASES: dict[str, Alias] = {
    "ATC_ANGLE_MAX": Alias("ANGLE_MAX", 100.0),
    "LAND_ALT_LOW_M": Alias("LAND_ALT_LOW", 100.0),
    "LAND_SPD_HIGH_MS": Alias("LAND_SPEED_HIGH", 100.0),
    "LAND_SPD_MS": Alias("LAND_SPEED", 100.0),
    "MAV_GCS_SYSID": Alias("SYSID_MYGCS"),
    "MAV_SYSID": Alias("SYSID_THISMAV"),
    "RTL_ALT_FINAL_M": Alias("RTL_ALT_FINAL", 100.0),
    "RTL_ALT_M": Alias("RTL_ALT", 100.0),
    "RTL_SPEED_MS": Alias("RTL_SPEED", 100.0),
    "SIM_GPS1_ENABLE": Alias("SIM_GPS_DISABLE", -1.0, 1.0),
    "SIM_GPS1_GLTCH_X": Alias("SIM_GPS_GLITCH_X"),
    "SIM_GPS1_GLTCH_Y": Alias("SIM_GPS_GLITCH_Y"),
    "SIM_GPS1_GLTCH_Z": Alias("SIM_GPS_GLITCH_Z"),
    "SIM_GPS1_NOISE": Alias("SIM_GPS_NOISE"),
    "SIM_GPS1_NUMSATS": Alias("SIM_GPS_NUMSATS"),
    "SIM_GPS1_VERR_X": Alias("SIM_GPS_VERR_X"),
    "SIM_GPS1_VERR_Y": Alias("SIM_GPS_VERR_Y"),
    "WP_ACC": Alias("WPNAV_ACCEL", 100.0),
    "WP_RADIUS_M": Alias("WPNAV_RADIUS", 100.0),
    "WP_SPD": Alias("WPNAV_SPEED", 100.0),
    "WP_SPD_DN": Alias("WPNAV_SPEED_DN", 100.0),
    "WP_SPD_UP": Alias("WPNAV_SPEED_UP", 100.0),
}

ARDUCOPTER_CATALOG = Catalog(TABLE, aliases=ALIASES)


def arducopter_values(config: VehicleConfig, system_id: int) -> dict[str, float]:
    """What differs from the defaults in a vehicle of this kind."""
    limits, battery = config.limits, config.battery
    return {
        "SYSID_THISMAV": float(system_id),
        "BATT_CAPACITY": float(round(battery.capacity_mah)),
        "BATT_LOW_VOLT": LOW_SHARE * battery.voltage_v,
        "ANGLE_MAX": float(round(100.0 * limits.tilt_deg)),
        "WPNAV_SPEED": 100.0 * limits.speed_m_s,
        "WPNAV_SPEED_UP": 100.0 * limits.climb_m_s,
        "WPNAV_SPEED_DN": 100.0 * limits.descent_m_s,
        "WPNAV_ACCEL": 100.0 * limits.acceleration_m_s2,
        **surroundings(config),
    }
