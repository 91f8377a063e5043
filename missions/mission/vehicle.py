"""What carries an agent: an autopilot and its airframe, simulated or behind a link."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from comms.transport import FORMS, transport_of
from missions.mission.part import Allowed, Part

Charge = Annotated[float, Field(gt=0, lt=1_000_000)]
Airspeed = Annotated[float, Field(ge=0, lt=100)]
SpeedLimit = Annotated[float, Field(ge=0.1, le=100)]
Bearing = Annotated[float, Field(ge=0, lt=360)]


def _link_url(text: str) -> str:
    transport_of(text)
    return text


LINKS = f"a list with a link for each agent: {FORMS}, or null"
LinkUrl = Annotated[str, AfterValidator(_link_url)]
SYSTEM_IDS = "a list with a whole number from 1 to 250, or null, for each agent"
MOST_SYSTEMS = 250  # MAVLink's other ids are those of ground stations
SystemId = Annotated[int, Field(ge=1, le=MOST_SYSTEMS)]


def simulated_system_id(uid: int) -> int:
    """The MAVLink system id of agent `uid`'s simulated vehicle; the 251st, alone on its own link, is 1 again."""
    return uid % MOST_SYSTEMS + 1


class Limits(Part):
    """What a vehicle can do."""

    speed_m_s: SpeedLimit = 10.0
    """Greatest horizontal speed."""
    acceleration_m_s2: SpeedLimit = 2.5
    """Greatest horizontal acceleration."""
    climb_m_s: SpeedLimit = 2.5
    """Greatest speed upward."""
    descent_m_s: SpeedLimit = 1.5
    """Greatest speed downward."""
    tilt_deg: Annotated[float, Field(ge=1, le=80)] = 30.0
    """Greatest lean."""


class Wind(Part):
    """The wind, the same everywhere."""

    speed_m_s: Airspeed = 0.0
    """Mean speed."""
    from_deg: Bearing = 0.0
    """Where it comes from, clockwise from north."""
    gust_m_s: Airspeed = 0.0
    """Greatest change of speed by gusts."""


class Battery(Part):
    """A vehicle's battery."""

    capacity_mah: Charge = 5000.0
    """Charge when full, in mAh."""
    voltage_v: Charge = 12.6
    """Voltage when full."""
    hover_current_a: Charge = 28.0
    """Current in hover."""


class Vehicle(Part):
    """What carries an agent: an autopilot and its airframe."""

    kind: Literal["simulated", "ideal", "link"] = "simulated"
    """`simulated`: flies as an airframe does; `ideal`: follows setpoints exactly; `link`: it flies elsewhere."""
    flavor: Literal["ardupilot", "px4"] = "ardupilot"
    """Whose autopilot a simulated vehicle has; one behind a link tells."""
    links: Annotated[tuple[LinkUrl | None, ...], Field(strict=False), Allowed(LINKS)] = ()
    """Where the vehicles are reached, by agent; null: that agent's is simulated. Only for kind `link`."""
    system_ids: Annotated[tuple[SystemId | None, ...], Field(strict=False), Allowed(SYSTEM_IDS)] = ()
    """The vehicles' MAVLink system ids, by agent; none or null: that of the first vehicle heard on the link."""
    signing_key: Annotated[Path | None, Field(strict=False), Allowed("null, or the path of a key file")] = None
    """Signs every link (MAVLink 2) with the key, or the passphrase, in this file, which its owner alone may read."""
    boot_s: Annotated[float, Field(ge=0, le=120)] = 2.0
    """Time from power-on until the autopilot is ready to arm."""
    limits: Limits = Limits()
    """What the vehicle can do."""
    wind: Wind = Wind()
    """The wind it flies in."""
    battery: Battery = Battery()
    """What it flies on."""
