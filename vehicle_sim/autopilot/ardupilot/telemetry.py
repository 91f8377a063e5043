"""What an ArduCopter reports in its own way (heartbeat, health, battery, mission, fence), and the table of it all."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.ardupilot.copter import Copter
from vehicle_sim.autopilot.ardupilot.modes import MODES, Mode
from vehicle_sim.autopilot.ardupilot.safety.arming import complaints
from vehicle_sim.autopilot.ardupilot.safety.battery import Level
from vehicle_sim.autopilot.ardupilot.safety.fence import Border
from vehicle_sim.autopilot.telemetry import SHARED, Builder
from vehicle_sim.autopilot.telemetry.fields import (
    CUSTOM_MODE,
    GUIDED_ENABLED,
    MANUAL_INPUT,
    SAFETY_ARMED,
    STABILIZED,
    i16,
    i32,
    remaining_percent,
    u16,
)

STANDBY, ACTIVE, CRITICAL = 3, 4, 5

# SYS_STATUS sensors as recorded, and the bits that come and go.
PRESENT, ENABLED, HEALTHY = 0x5371FC0F, 0x52419C0F, 0x47519C0F
COMPASS, GPS, FENCE, AHRS, CONTROLLERS, LOGGING, BATTERY, PREARM = (
    0x4,
    0x20,
    0x100000,
    0x200000,
    0x6000,
    0x1000000,
    0x2000000,
    0x10000000,
)

# What this autopilot really has, of the bits that ArduCopter sets.
MISSION_FLOAT, PARAM_FLOAT, MISSION_INT, COMMAND_INT = 1, 2, 4, 8
SET_ATTITUDE, SET_LOCAL, SET_GLOBAL, TERMINATION = 64, 128, 256, 2048
MAVLINK2, FENCES, RALLIES = 8192, 16384, 32768
CAPABILITIES = (
    MISSION_FLOAT | PARAM_FLOAT | MISSION_INT | COMMAND_INT | SET_ATTITUDE | SET_LOCAL | SET_GLOBAL | TERMINATION
    | MAVLINK2 | FENCES | RALLIES
)  # fmt: skip
FENCE_BREACH = {Border.NONE: 0, Border.ALT_MIN: 1, Border.ALT_MAX: 2, Border.CIRCLE: 3, Border.POLYGON: 3}
VERSION_4_5_5 = 0x040505FF


def heartbeat(pilot: Copter) -> Any:
    base = CUSTOM_MODE | STABILIZED | MANUAL_INPUT
    if MODES[pilot.mode].autonomous:
        base |= GUIDED_ENABLED
    if pilot.armed:
        base |= SAFETY_ARMED
    status = ACTIVE if pilot.flying or pilot.boot.stage.booting else STANDBY
    if pilot.failsafes.active:
        status = CRITICAL
    return dialect.MAVLink_heartbeat_message(2, 3, base, int(pilot.mode), status, 3)


def sys_status(pilot: Copter) -> Any:
    stage = pilot.boot.stage
    present, enabled, healthy = PRESENT, ENABLED, HEALTHY
    if stage.gps_fix:
        present, enabled, healthy = present | GPS, enabled | GPS, healthy | GPS
    if stage.origin:
        enabled, healthy = enabled | AHRS, healthy | AHRS
    if MODES[pilot.mode].needs_position:
        enabled, healthy = enabled | CONTROLLERS, healthy | CONTROLLERS
    if pilot.sensors.faults.compass_dead:
        healthy &= ~COMPASS
    if pilot.failsafes.battery.level is not Level.FINE:
        healthy &= ~BATTERY
    if pilot.parameters["FENCE_ENABLE"]:
        enabled |= FENCE
    if pilot.fence.breached:
        healthy &= ~FENCE
    if pilot.armed:
        enabled |= LOGGING
    if pilot.armed or not complaints(pilot):
        healthy |= PREARM
    charge = pilot.charge
    return dialect.MAVLink_sys_status_message(
        present, enabled, healthy, 0, u16(charge.voltage_v * 1000.0), i16(charge.current_a * 100.0),
        _remaining_percent(pilot), 0, 0, 0, 0, 0, 0,
    )  # fmt: skip


def battery_status(pilot: Copter) -> Any:
    charge = pilot.charge
    volts = charge.voltage_v
    return dialect.MAVLink_battery_status_message(
        0, 0, 0, 32767, [u16(volts * 1000.0)] + [65535] * 9, i16(charge.current_a * 100.0),
        i32(charge.consumed_mah), i32(charge.consumed_mah * volts * 0.036), _remaining_percent(pilot), 0,
        1 + int(pilot.failsafes.battery.level),
    )  # fmt: skip


def _remaining_percent(pilot: Copter) -> int:
    return remaining_percent(pilot, pilot.parameters["BATT_CAPACITY"])


def autopilot_version(pilot: Copter) -> Any:
    return dialect.MAVLink_autopilot_version_message(
        CAPABILITIES, VERSION_4_5_5, 0, 0, 0, list(b"142aece2"), [0] * 8, [0] * 8, 0, 0, pilot.system_id
    )


def mission_current(pilot: Copter) -> Any:
    """The item that is flown; `total` counts without home."""
    mission = pilot.mission
    flies = int(pilot.mode is Mode.AUTO)
    return dialect.MAVLink_mission_current_message(
        mission.current, max(0, len(mission.items) - 1), int(mission.state), flies
    )


def fence_status(pilot: Copter) -> Any:
    """Nothing while the fence is switched off."""
    fence = pilot.fence
    if not pilot.parameters["FENCE_ENABLE"]:
        return None
    at_ms = round(1000.0 * max(0.0, fence.breached_at_s - pilot.started_at_s)) & 0xFFFFFFFF
    kind = FENCE_BREACH[fence.last if fence.breached else Border.NONE]
    return dialect.MAVLink_fence_status_message(int(bool(fence.breached)), min(65535, fence.breaches), kind, at_ms)


BUILDERS: dict[int, Builder] = SHARED | {
    0: heartbeat,
    1: sys_status,
    42: mission_current,
    147: battery_status,
    148: autopilot_version,
    162: fence_status,
}
