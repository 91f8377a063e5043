"""What the vehicle has said about itself, brought into the mission's frame and checked on the way in."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, isfinite, tau

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint, Vec3, enu_from_geo
from comms.mavlink import Message

LARGEST_POSITION_M = 1e6  # a vehicle that says it is farther from its own origin is not believed
LARGEST_SPEED_M_S = 1e3
FRAMES_AGREE_M = 25.0  # local and global position may differ by this: GPS noise, a second of flight, the tangent plane
LOCAL_LAG_M_S = 1.0
LOW = frozenset({
    dialect.MAV_BATTERY_CHARGE_STATE_LOW, dialect.MAV_BATTERY_CHARGE_STATE_CRITICAL,
    dialect.MAV_BATTERY_CHARGE_STATE_EMERGENCY, dialect.MAV_BATTERY_CHARGE_STATE_FAILED,
    dialect.MAV_BATTERY_CHARGE_STATE_UNHEALTHY,
})  # fmt: skip
NOT_MEASURED = (0, 65535)  # SYS_STATUS.voltage_battery of a vehicle without a battery monitor
RESTART_MS = 5000  # a boot clock that falls back this far belongs to a new boot


class Telemetry:
    """The newest of everything one vehicle says. Fed with messages, read by the phases; ENU meters.

    Attributes:
        heartbeat_at_s, position_at_s, attitude_at_s: when they were last heard; None before.
        heartbeat_gap_s: between the last heartbeat and the one before.
        autopilot: HEARTBEAT.autopilot, None before the first.
        origin_m: the vehicle's own origin in the mission's frame.
        position_m, velocity_m_s: in the mission's frame; position None until origin and local position are known.
        battery_low: the autopilot calls its battery low, or worse.
        has_fix: the autopilot's estimator knows where it is (True where the autopilot does not report on it).
        landed_state: MAV_LANDED_STATE; 0 unknown.
        prearm_ok: the pre-arm health bit.
        restarts: how many times its boot clock fell back.
        ignored: messages with numbers no vehicle can mean.
    """

    __slots__ = (
        "armed", "attitude_at_s", "autopilot", "battery", "battery_low", "boot_ms", "clock_at_s", "custom_mode", "geo",
        "has_fix", "heading_rad", "heartbeat_at_s", "heartbeat_gap_s", "home", "ignored", "landed_state", "local_enu_m",
        "origin_m", "position_at_s", "position_m", "prearm_ok", "restarts", "system_status", "velocity_m_s",
        "voltage_v",
    )  # fmt: skip

    def __init__(self, home: GeoPoint) -> None:
        self.home = home
        self.heartbeat_at_s: float | None = None
        self.autopilot: int | None = None
        self.armed = False
        self.custom_mode = -1
        self.system_status = 0
        self.restarts = 0
        self.ignored = 0
        self.heartbeat_gap_s = 0.0
        self.clock_at_s = 0.0
        self.forget()

    def forget(self) -> None:
        """Drop what does not outlive a restart of the vehicle."""
        self.boot_ms = 0
        self.origin_m: Vec3 | None = None
        self.local_enu_m: Vec3 | None = None
        self.position_m: Vec3 | None = None
        self.velocity_m_s: Vec3 | None = None
        self.position_at_s: float | None = None
        self.attitude_at_s: float | None = None
        self.heading_rad = 0.0
        self.battery: float | None = None
        self.battery_low = False
        self.voltage_v: float | None = None
        self.landed_state = 0
        self.prearm_ok = False
        self.has_fix = True
        self.geo: GeoPoint | None = None

    def hear(self, message: Message, now_s: float) -> None:
        """Take in one message of this vehicle; what it does not care for, and what is absurd, changes nothing."""
        handler = HANDLERS.get(type(message))
        if handler is not None and not handler(self, message, now_s):
            self.ignored += 1

    @property
    def landed(self) -> bool | None:
        """On the ground: as EXTENDED_SYS_STATE says, else as the heartbeat's status does; None before the first."""
        if self.landed_state:
            return self.landed_state == ON_GROUND
        if self.heartbeat_at_s is None:
            return None
        return not (self.armed and self.system_status in IN_FLIGHT)

    @property
    def frames_agree(self) -> bool:
        """The mission-frame position is where GLOBAL_POSITION_INT is, too (True while either is unknown)."""
        if self.geo is None or self.position_m is None:
            return True
        east, north, _ = enu_from_geo(self.home, self.geo)
        speed_m_s = hypot(*self.velocity_m_s) if self.velocity_m_s else 0.0
        allowed_m = FRAMES_AGREE_M + LOCAL_LAG_M_S * speed_m_s
        return hypot(east - self.position_m[0], north - self.position_m[1]) <= allowed_m

    def place(self) -> None:
        """Put the local position into the mission's frame, if origin and position are both known."""
        if self.origin_m is not None and self.local_enu_m is not None:
            east, north, up = self.local_enu_m
            origin = self.origin_m
            self.position_m = (origin[0] + east, origin[1] + north, origin[2] + up)

    def clock(self, boot_ms: int, now_s: float) -> None:
        """Watch the vehicle's boot clock: when it falls back, what was known is of another life.

        After a long silence it may be ahead of the last one heard and still a new one: it has not run all the while.
        """
        silent_ms = 1000.0 * (now_s - self.clock_at_s)
        stood_still = not self.armed and boot_ms - self.boot_ms + RESTART_MS < silent_ms
        self.clock_at_s = now_s
        if boot_ms + RESTART_MS < self.boot_ms or (self.boot_ms > 0 and stood_still):
            self.restarts += 1
            self.forget()
        self.boot_ms = boot_ms


ON_GROUND: int = dialect.MAV_LANDED_STATE_ON_GROUND
# In the air while armed; CRITICAL is what ArduPilot says during a failsafe.
IN_FLIGHT = frozenset({dialect.MAV_STATE_ACTIVE, dialect.MAV_STATE_CRITICAL, dialect.MAV_STATE_EMERGENCY})


def _heartbeat(telemetry: Telemetry, message: Message, now_s: float) -> bool:
    if telemetry.heartbeat_at_s is not None:
        telemetry.heartbeat_gap_s = now_s - telemetry.heartbeat_at_s
    telemetry.heartbeat_at_s = now_s
    telemetry.autopilot = message.autopilot
    telemetry.armed = bool(message.base_mode & dialect.MAV_MODE_FLAG_SAFETY_ARMED)
    telemetry.custom_mode = message.custom_mode
    telemetry.system_status = message.system_status
    return True


def _local_position(telemetry: Telemetry, message: Message, now_s: float) -> bool:
    north, east, down = message.x, message.y, message.z
    v_north, v_east, v_down = message.vx, message.vy, message.vz
    # NaN fails every comparison, so these two lines refuse it as well.
    if not (abs(north) + abs(east) + abs(down) < LARGEST_POSITION_M):
        return False
    if not (abs(v_north) + abs(v_east) + abs(v_down) < LARGEST_SPEED_M_S):
        return False
    telemetry.clock(message.time_boot_ms, now_s)
    telemetry.local_enu_m = (east, north, -down)
    telemetry.velocity_m_s = (v_east, v_north, -v_down)
    telemetry.position_at_s = now_s
    telemetry.place()
    return True


def _attitude(telemetry: Telemetry, message: Message, now_s: float) -> bool:
    if not isfinite(message.yaw):
        return False
    telemetry.clock(message.time_boot_ms, now_s)
    telemetry.attitude_at_s = now_s
    telemetry.heading_rad = message.yaw % tau
    return True


def _origin(telemetry: Telemetry, message: Message, now_s: float) -> bool:
    place = _geo_point(message.latitude, message.longitude, message.altitude)
    if place is None:
        return False
    telemetry.origin_m = enu_from_geo(telemetry.home, place)
    telemetry.place()
    return True


def _global_position(telemetry: Telemetry, message: Message, now_s: float) -> bool:
    telemetry.geo = _geo_point(message.lat, message.lon, message.alt)
    return True


def _status(telemetry: Telemetry, message: Message, now_s: float) -> bool:
    health = message.onboard_control_sensors_health
    telemetry.prearm_ok = bool(health & dialect.MAV_SYS_STATUS_PREARM_CHECK)
    millivolts = message.voltage_battery
    telemetry.voltage_v = None if millivolts in NOT_MEASURED else millivolts / 1000.0
    return _remaining(telemetry, message.battery_remaining)


def _battery(telemetry: Telemetry, message: Message, now_s: float) -> bool:
    if message.id != 0:
        return True
    telemetry.battery_low = message.charge_state in LOW
    return _remaining(telemetry, message.battery_remaining)


def _remaining(telemetry: Telemetry, percent: int) -> bool:
    if not -1 <= percent <= 100:
        return False
    telemetry.battery = percent / 100.0 if percent >= 0 else None
    return True


def _landed_state(telemetry: Telemetry, message: Message, now_s: float) -> bool:
    telemetry.landed_state = message.landed_state
    return True


def _estimator(telemetry: Telemetry, message: Message, now_s: float) -> bool:
    telemetry.has_fix = bool(message.flags & dialect.EKF_POS_HORIZ_ABS)
    return True


def _geo_point(latitude_e7: int, longitude_e7: int, altitude_mm: int) -> GeoPoint | None:
    """A place from MAVLink's integers; None for no place: 0, 0 is what an autopilot says that has none yet."""
    if not (abs(latitude_e7) < 900_000_000 and abs(longitude_e7) <= 1_800_000_000):
        return None
    if latitude_e7 == 0 and longitude_e7 == 0:
        return None
    return GeoPoint(latitude_e7 / 1e7, longitude_e7 / 1e7, altitude_mm / 1e3)


# Message type -> what it changes; each tells whether the message made sense.
HANDLERS: dict[type, Callable[[Telemetry, Message, float], bool]] = {
    dialect.MAVLink_heartbeat_message: _heartbeat,
    dialect.MAVLink_local_position_ned_message: _local_position,
    dialect.MAVLink_attitude_message: _attitude,
    dialect.MAVLink_gps_global_origin_message: _origin,
    dialect.MAVLink_global_position_int_message: _global_position,
    dialect.MAVLink_sys_status_message: _status,
    dialect.MAVLink_battery_status_message: _battery,
    dialect.MAVLink_extended_sys_state_message: _landed_state,
    dialect.MAVLink_ekf_status_report_message: _estimator,
}
