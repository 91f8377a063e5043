"""What the agent may know of its vehicle."""

from __future__ import annotations

from enum import StrEnum

import msgspec

from comms.frames import Vec3


class Phase(StrEnum):
    """Where the pilot stands between switched on and landed.

    CONNECT -> PREFLIGHT -> ARM -> TAKEOFF -> ON_STATION <-> FLYING -> RETURN | LAND -> DONE; from the air also
    TAKEN_OVER (and back), from anywhere FAILED; when the autopilot restarts, PREFLIGHT again.
    """

    CONNECT = "connect"  # no heartbeat yet
    PREFLIGHT = "preflight"  # message rates, position, return altitude, pre-arm checks, guided mode
    ARM = "arm"
    TAKEOFF = "takeoff"  # climbing to the layer
    ON_STATION = "on station"  # holding on the layer
    FLYING = "flying"  # following the agent's velocity
    TAKEN_OVER = "taken over"  # somebody else chose a flight mode: hands off until it is guided again
    RETURN = "return"
    LAND = "land"
    DONE = "done"  # landed and disarmed as intended
    FAILED = "failed"  # given up, with a reason; a vehicle in the air is asked to land


class PilotState(msgspec.Struct, frozen=True, kw_only=True):
    """The vehicle at one tick, as its autopilot tells it. ENU meters in the mission's frame.

    Attributes:
        ready: it has reached its layer and follows `Fly` now.
        position_m, velocity_m_s: None until the autopilot has a position and its origin is known.
        heading_rad: where the nose points, clockwise from north, 0 to 2 pi.
        battery: remaining share, 0 to 1; None when unknown. voltage_v: likewise. battery_low: the autopilot calls it
            low, or worse.
        landed: on the ground; None when not yet told.
        link_lost: no heartbeat for `PilotConfig.link_lost_s`.
        failure: why the phase is FAILED, else empty.
    """

    phase: Phase
    ready: bool
    position_m: Vec3 | None
    velocity_m_s: Vec3 | None
    heading_rad: float
    battery: float | None
    voltage_v: float | None
    battery_low: bool
    armed: bool
    flight_mode: str
    landed: bool | None
    link_lost: bool
    failure: str
