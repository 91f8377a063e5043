"""What any autopilot is doing and how it is: time, landed state, power, memory, motors, sticks."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.telemetry.fields import boot_ms, throttle, u16

ON_GROUND, IN_AIR, TAKING_OFF, LANDING = 1, 2, 3, 4  # EXTENDED_SYS_STATE.landed_state

BOOTED_AT_UNIX_S = 1_767_225_600  # 2026-01-01: the mission clock has no date, GPS time must have one
CENTER_US, LOW_US, HALF_US = 1500, 1000, 500  # of a remote control
SLOWEST_US, FASTEST_US = 1247.0, 1950  # motors of an armed vehicle: 1587 at the 34 % of a hover (recorded)
SWITCHES_US = (1800, 1000, 1000, 1800)  # its channels 5 to 8 (recorded)


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
