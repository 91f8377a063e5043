"""The SIM_* parameters: how a ground station makes the simulated world misbehave. They act at once."""

from __future__ import annotations

from math import cos, radians
from typing import TypedDict

from comms.frames import METRES_PER_DEGREE
from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.sensors import Faults
from vehicle_sim.wind import Wind

SENSOR_NAMES = ("SIM_ACC", "SIM_BARO", "SIM_GPS", "SIM_GYR", "SIM_MAG", "COMPASS_OFS")  # the beginnings of their names
FURTHEST_M = 1e6
MOTORS = 4


def sensor_faults(p: Parameters, latitude_deg: float) -> Faults:
    """What is wrong with the sensors of a vehicle near `latitude_deg`."""
    east_m_deg = METRES_PER_DEGREE * cos(radians(latitude_deg))
    return Faults(
        gps_lost=p["SIM_GPS_DISABLE"] != 0.0,
        satellites=round(within(p["SIM_GPS_NUMSATS"], 0.0, 60.0)),
        gps_error_ned_m=(
            within(METRES_PER_DEGREE * p["SIM_GPS_GLITCH_X"], -FURTHEST_M, FURTHEST_M),
            within(east_m_deg * p["SIM_GPS_GLITCH_Y"], -FURTHEST_M, FURTHEST_M),
            within(-p["SIM_GPS_GLITCH_Z"], -FURTHEST_M, FURTHEST_M),
        ),
        gps_velocity_error_ne_m_s=_both(p, "SIM_GPS_VERR_X", "SIM_GPS_VERR_Y", 100.0),
        gps_noise_m=within(p["SIM_GPS_NOISE"], 0.0, 1000.0),
        accel_error_frd_m_s2=(
            *_both(p, "SIM_ACC1_BIAS_X", "SIM_ACC1_BIAS_Y", 10.0),
            within(p["SIM_ACC1_BIAS_Z"], -10.0, 10.0),
        ),
        accel_noise_m_s2=within(p["SIM_ACC1_RND"], 0.0, 100.0),
        gyro_yaw_error_rad_s=within(p["SIM_GYR1_BIAS_Z"], -10.0, 10.0),
        gyro_noise_rad_s=within(p["SIM_GYR1_RND"], 0.0, 10.0),
        baro_error_m=within(p["SIM_BARO_GLITCH"], -10_000.0, 10_000.0),
        baro_drift_m_s=within(p["SIM_BARO_DRIFT"], -100.0, 100.0),
        baro_noise_m=within(p["SIM_BARO_RND"], 0.0, 1000.0),
        baro_stuck=p["SIM_BARO_FREEZE"] != 0.0,
        compass_dead=p["SIM_MAG1_FAIL"] != 0.0,
        compass_offset_fr_mgauss=(
            within(p["SIM_MAG1_OFS_X"] - p["COMPASS_OFS_X"], -5000.0, 5000.0),
            within(p["SIM_MAG1_OFS_Y"] - p["COMPASS_OFS_Y"], -5000.0, 5000.0),
        ),
        compass_noise_mgauss=within(p["SIM_MAG_RND"], 0.0, 5000.0),
        anomaly_ne_mgauss=_both(p, "SIM_MAG_ALY_X", "SIM_MAG_ALY_Y", 5000.0),
        anomaly_height_m=within(p["SIM_MAG_ALY_HGT"], 0.1, 1000.0),
    )


def wind(p: Parameters) -> Wind:
    return Wind(
        speed_m_s=within(p["SIM_WIND_SPD"], 0.0, 99.0),
        from_deg=within(p["SIM_WIND_DIR"], -360.0, 360.0),
        gust_m_s=within(p["SIM_WIND_TURB"], 0.0, 99.0),
    )


class Supply(TypedDict):
    """What `Charge.supply` takes."""

    voltage_v: float
    capacity_mah: float


def battery(p: Parameters) -> Supply:
    return {
        "voltage_v": within(p["SIM_BATT_VOLTAGE"], 0.0, 1000.0),
        "capacity_mah": 1000.0 * within(p["SIM_BATT_CAP_AH"], 0.0, 1000.0),
    }


def motor_share(p: Parameters) -> float:
    """Share of its thrust that the weakest of four motors gives."""
    return within(p["SIM_ENGINE_MUL"], 0.0, 1.0) if 0.0 <= p["SIM_ENGINE_FAIL"] < MOTORS else 1.0


def within(value: float, lowest: float, highest: float) -> float:
    return max(lowest, min(highest, value))


def _both(p: Parameters, x: str, y: str, largest: float) -> tuple[float, float]:
    return within(p[x], -largest, largest), within(p[y], -largest, largest)
