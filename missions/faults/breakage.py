"""What a fault breaks in a vehicle, as the SIM_* parameters that break it (by ArduCopter's names, in every flavor)."""

from __future__ import annotations

from math import cos, radians

from comms.frames import METRES_PER_DEGREE
from missions.mission import Mission
from missions.mission.faults import BatteryLow, Fault, GpsGlitch, GpsLost, WindChange
from vehicle_sim.battery import voltage_at


def broken(fault: Fault, mission: Mission) -> dict[str, float]:
    """The parameters that a fault sets while it lasts; none if it is no fault of a vehicle's."""
    match fault:
        case GpsLost():
            return {"SIM_GPS_DISABLE": 1.0}
        case GpsGlitch():
            north_deg = fault.north_m / METRES_PER_DEGREE
            east_deg = fault.east_m / (METRES_PER_DEGREE * cos(radians(mission.home.latitude_deg)))
            return {"SIM_GPS_GLITCH_X": north_deg, "SIM_GPS_GLITCH_Y": east_deg}
        case BatteryLow():
            battery = mission.vehicle.battery
            return {
                "SIM_BATT_CAP_AH": battery.capacity_mah / 1000.0,
                "SIM_BATT_VOLTAGE": battery.voltage_v * voltage_at(fault.charge),
            }
        case WindChange():
            return {
                "SIM_WIND_SPD": fault.speed_m_s,
                "SIM_WIND_DIR": fault.from_deg,
                "SIM_WIND_TURB": fault.gust_m_s,
            }
    return {}
