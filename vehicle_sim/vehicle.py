"""A simulated vehicle from outside: how a mission describes it, and where it really is."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from comms.frames import Vec3
from vehicle_sim.battery import Battery
from vehicle_sim.flight import FlightLimits
from vehicle_sim.wind import Wind

Kind = Literal["simulated", "ideal"]
KINDS: tuple[Kind, ...] = ("simulated", "ideal")
FlavorName = Literal["ardupilot", "px4"]
# How long the real ones take from power-on until they are ready to arm (ArduCopter: recorded; PX4: its SITL, roughly).
READY_S: dict[FlavorName, float] = {"ardupilot": 41.16, "px4": 10.0}
FLAVOR_NAMES: tuple[FlavorName, ...] = tuple(READY_S)


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleConfig:
    """One simulated vehicle.

    Attributes:
        kind: "simulated" flies with inertia and wind; "ideal" speaks the same MAVLink and follows each velocity
            setpoint exactly, within its speed limits.
        flavor: whose autopilot it has: an ArduCopter's ("ardupilot") or a PX4's.
        boot_s: from power-on to armable, in the same order and with the same texts as the real one (READY_S).
    """

    kind: Kind = "simulated"
    flavor: FlavorName = "ardupilot"
    boot_s: float = 2.0
    limits: FlightLimits = field(default_factory=FlightLimits)
    wind: Wind = field(default_factory=Wind)
    battery: Battery = field(default_factory=Battery)

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise ValueError(f"vehicle.kind is one of {', '.join(KINDS)}, not {self.kind!r}")
        if self.flavor not in FLAVOR_NAMES:
            raise ValueError(f"vehicle.flavor is one of {', '.join(FLAVOR_NAMES)}, not {self.flavor!r}")
        if not 0.0 <= self.boot_s <= 600.0:
            raise ValueError(f"vehicle.boot_s is 0 to 600 s, not {self.boot_s}")


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleTruth:
    """Where a vehicle really is: north-east-down meters from its own home, meters a second, radians."""

    position_ned_m: Vec3
    velocity_ned_m_s: Vec3
    roll_rad: float
    pitch_rad: float
    yaw_rad: float
    on_ground: bool
    armed: bool
