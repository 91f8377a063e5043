"""What one pilot has to know before it starts: which vehicle, which layer, which limits."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from comms.frames import GeoPoint

GROUND_SYSTEM_ID = 255  # ArduPilot's ground-station failsafe counts the heartbeats of this system alone
COMPANION_COMPONENT_ID = 191  # tells our answers from those of a ground station (255/190) on the same vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class PilotConfig:
    """The pilot of one vehicle.

    Attributes:
        uid: the agent's number, named in errors.
        system_id: the vehicle's MAVLink system id; None: that of the first autopilot heard on the link.
        home: origin of the mission's ENU frame; its altitude counts, layers are meters above it.
        altitude_m: the layer this vehicle flies at, up of `home`; also the altitude it returns at.
        max_speed_m_s: no horizontal setpoint is faster.
        max_climb_m_s: no vertical setpoint is faster, up or down.
        layer_tolerance_m: on the layer means this close to it.
        max_offset_m: a vehicle whose own origin is farther from `home` has the wrong mission.
        link_lost_s: this long without a heartbeat is a lost link.
        connect_limit_s, preflight_limit_s: how long to wait for the first heartbeat, and until the checks pass.
        refusal_limit_s: how long a refused request is repeated before the pilot gives up.
        return_limit_s: a return that takes longer becomes a landing on the spot.

    Raises:
        ValueError: a number out of its range; the text names the agent, the field and the range.
    """

    uid: int
    system_id: int | None
    home: GeoPoint
    altitude_m: float
    max_speed_m_s: float
    max_climb_m_s: float = 1.5
    layer_tolerance_m: float = 0.5
    max_offset_m: float = 10_000.0
    link_lost_s: float = 5.0
    connect_limit_s: float = 60.0
    preflight_limit_s: float = 180.0
    refusal_limit_s: float = 60.0
    return_limit_s: float = 900.0
    ground_system_id: int = GROUND_SYSTEM_ID
    ground_component_id: int = COMPANION_COMPONENT_ID

    def __post_init__(self) -> None:
        for field, low, high in RANGES:
            value = getattr(self, field)
            if value is None and field == "system_id":
                continue
            if not (isfinite(value) and low <= value <= high):
                raise ValueError(f"pilot of agent {self.uid}: {field} is {value}, allowed is {low:g} to {high:g}")
        home = self.home
        place = (home.latitude_deg, home.longitude_deg, home.altitude_m)
        if not (all(map(isfinite, place)) and abs(place[0]) < 90.0 and abs(place[1]) <= 180.0):
            raise ValueError(f"pilot of agent {self.uid}: home {place} is no place on the globe")


RANGES: tuple[tuple[str, float, float], ...] = (
    ("system_id", 1, 250),
    ("altitude_m", 2.0, 500.0),
    ("max_speed_m_s", 0.1, 50.0),
    ("max_climb_m_s", 0.1, 10.0),
    ("layer_tolerance_m", 0.1, 5.0),
    ("max_offset_m", 1.0, 100_000.0),
    ("link_lost_s", 1.5, 600.0),
    ("connect_limit_s", 1.0, 86_400.0),
    ("preflight_limit_s", 1.0, 86_400.0),
    ("refusal_limit_s", 1.0, 86_400.0),
    ("return_limit_s", 1.0, 86_400.0),
    ("ground_system_id", 1, 255),
    ("ground_component_id", 1, 255),
)
