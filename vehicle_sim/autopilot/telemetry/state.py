"""What the autopilot is doing and how it is: heartbeat, health, battery, version, power."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.arming import complaints
from vehicle_sim.autopilot.battery_failsafe import Level
from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.fence import Border
from vehicle_sim.autopilot.modes import MODES, Mode
from vehicle_sim.autopilot.telemetry.fields import boot_ms, i16, i32, throttle, u16

# HEARTBEAT.base_mode
CUSTOM_MODE, STABILIZED, MANUAL_INPUT, GUIDED_ENABLED, SAFETY_ARMED = 1, 16, 64, 8, 128
STANDBY, ACTIVE, CRITICAL = 3, 4, 5
ON_GROUND, IN_AIR, TAKING_OFF, LANDING = 1, 2, 3, 4  # EXTENDED_SYS_STATE.landed_state

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
BOOTED_AT_UNIX_S = 1_767_225_600  # 2026-01-01: the mission clock has no date, GPS time must have one
CENTER_US, LOW_US, HALF_US = 1500, 1000, 500  # of a remote control
SLOWEST_US, FASTEST_US = 1247.0, 1950  # motors of an armed vehicle: 1587 at the 34 % of a hover (recorded)
SWITCHES_US = (1800, 1000, 1000, 1800)  # its channels 5 to 8 (recorded)


def heartbeat(pilot: Autopilot) -> Any:
    base = CUSTOM_MODE | STABILIZED | MANUAL_INPUT
    if MODES[pilot.mode].autonomous:
        base |= GUIDED_ENABLED
    if pilot.armed:
        base |= SAFETY_ARMED
    status = ACTIVE if pilot.flying or pilot.boot.stage.booting else STANDBY
    if pilot.failsafes.active:
        status = CRITICAL
    return dialect.MAVLink_heartbeat_message(2, 3, base, int(pilot.mode), status, 3)


def sys_status(pilot: Autopilot) -> Any:
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


def battery_status(pilot: Autopilot) -> Any:
    charge = pilot.charge
    volts = charge.voltage_v
    return dialect.MAVLink_battery_status_message(
        0, 0, 0, 32767, [u16(volts * 1000.0)] + [65535] * 9, i16(charge.current_a * 100.0),
        i32(charge.consumed_mah), i32(charge.consumed_mah * volts * 0.036), _remaining_percent(pilot), 0,
        1 + int(pilot.failsafes.battery.level),
    )  # fmt: skip


def _remaining_percent(pilot: Autopilot) -> int:
    """What the autopilot believes to be left: BATT_CAPACITY less what was drawn."""
    capacity_mah = pilot.parameters["BATT_CAPACITY"]
    if capacity_mah <= 0.0:
        return 0
    return round(100.0 * max(0.0, 1.0 - pilot.charge.consumed_mah / capacity_mah))


def system_time(pilot: Autopilot) -> Any:
    fixed = pilot.boot.stage.gps_fix
    return dialect.MAVLink_system_time_message(
        round((BOOTED_AT_UNIX_S + pilot.now_s) * 1e6) if fixed else 0, boot_ms(pilot)
    )


def extended_sys_state(pilot: Autopilot) -> Any:
    landed = IN_AIR
    if not pilot.flying:
        landed = ON_GROUND
    elif pilot.guidance.landing:
        landed = LANDING
    elif pilot.guidance.taking_off:
        landed = TAKING_OFF
    return dialect.MAVLink_extended_sys_state_message(3, landed)


def autopilot_version(pilot: Autopilot) -> Any:
    return dialect.MAVLink_autopilot_version_message(
        CAPABILITIES, VERSION_4_5_5, 0, 0, 0, list(b"142aece2"), [0] * 8, [0] * 8, 0, 0, pilot.system_id
    )


def mission_current(pilot: Autopilot) -> Any:
    """The item that is flown; `total` counts without home."""
    mission = pilot.mission
    flies = int(pilot.mode is Mode.AUTO)
    return dialect.MAVLink_mission_current_message(
        mission.current, max(0, len(mission.items) - 1), int(mission.state), flies
    )


def fence_status(pilot: Autopilot) -> Any:
    """Nothing while the fence is switched off."""
    fence = pilot.fence
    if not pilot.parameters["FENCE_ENABLE"]:
        return None
    at_ms = round(1000.0 * max(0.0, fence.breached_at_s - pilot.started_at_s)) & 0xFFFFFFFF
    kind = FENCE_BREACH[fence.last if fence.breached else Border.NONE]
    return dialect.MAVLink_fence_status_message(int(bool(fence.breached)), min(65535, fence.breaches), kind, at_ms)


def power_status(pilot: Autopilot) -> Any:
    return dialect.MAVLink_power_status_message(5000, 0, 0)


def meminfo(pilot: Autopilot) -> Any:
    return dialect.MAVLink_meminfo_message(0, 65535, 131072)


def servo_output_raw(pilot: Autopilot) -> Any:
    """Four motors alike."""
    motor_us = min(FASTEST_US, round(SLOWEST_US + 1000.0 * throttle(pilot))) if pilot.armed else LOW_US
    return dialect.MAVLink_servo_output_raw_message(boot_ms(pilot) * 1000 & 0xFFFFFFFF, 0, *[motor_us] * 4, 0, 0, 0, 0)


def rc_channels(pilot: Autopilot) -> Any:
    """The sticks, and the switches of a remote control that nobody touches."""
    roll, pitch, yaw, throttle_share = pilot.guidance.steering.sticks
    sticks_us = (
        CENTER_US + HALF_US * roll, CENTER_US - HALF_US * pitch, LOW_US + 2.0 * HALF_US * throttle_share,
        CENTER_US + HALF_US * yaw,
    )  # fmt: skip
    return dialect.MAVLink_rc_channels_message(boot_ms(pilot), 16, *map(u16, sticks_us), *SWITCHES_US, *[0] * 10, 255)
