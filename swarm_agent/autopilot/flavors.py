"""Where autopilots differ: one row each. Whoever adds an autopilot adds a row, not branches elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from pymavlink.dialects.v20 import ardupilotmega as dialect


@dataclass(frozen=True, slots=True)
class Mode:
    """A flight mode: as HEARTBEAT reports it and as DO_SET_MODE asks for it (its parameters 2 and 3)."""

    name: str
    custom_mode: int
    asked_with: tuple[float, float]


@dataclass(frozen=True, slots=True)
class AltitudeParameter:
    """A parameter that holds an altitude above the vehicle's home, in `units_per_m`."""

    name: str
    type: int
    units_per_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Flavor:
    """One family of autopilots.

    Attributes:
        guided, homing, landing: the modes for following setpoints, for flying home, for landing on the spot.
        ends_flight: every custom_mode in which the vehicle comes down by itself.
        mode_names: custom_mode -> name.
        takeoff_is_amsl: NAV_TAKEOFF counts from the sea, not from the vehicle's home.
        return_altitude: the names the parameter goes by, tried in this order.
        setpoint_memory_s: the vehicle follows its last velocity setpoint for so long.
    """

    name: str
    guided: Mode
    homing: Mode
    landing: Mode
    ends_flight: frozenset[int]
    mode_names: Mapping[int, str]
    takeoff_is_amsl: bool
    return_altitude: tuple[AltitudeParameter, ...]
    setpoint_memory_s: float

    def mode_name(self, custom_mode: int) -> str:
        """The mode in the autopilot's own words."""
        return self.mode_names.get(custom_mode, f"MODE {custom_mode}")


ARDUCOPTER_MODES = MappingProxyType(
    {
        0: "STABILIZE",
        1: "ACRO",
        2: "ALT_HOLD",
        3: "AUTO",
        4: "GUIDED",
        5: "LOITER",
        6: "RTL",
        7: "CIRCLE",
        9: "LAND",
        11: "DRIFT",
        13: "SPORT",
        14: "FLIP",
        15: "AUTOTUNE",
        16: "POSHOLD",
        17: "BRAKE",
        18: "THROW",
        19: "AVOID_ADSB",
        20: "GUIDED_NOGPS",
        21: "SMART_RTL",
        22: "FLOWHOLD",
        23: "FOLLOW",
        24: "ZIGZAG",
        25: "SYSTEMID",
        26: "AUTOROTATE",
        27: "AUTO_RTL",
    }
)

ARDUPILOT = Flavor(
    name="ardupilot",
    guided=Mode("GUIDED", 4, (4.0, 0.0)),
    homing=Mode("RTL", 6, (6.0, 0.0)),
    landing=Mode("LAND", 9, (9.0, 0.0)),
    ends_flight=frozenset({6, 9, 21, 27}),
    mode_names=ARDUCOPTER_MODES,
    takeoff_is_amsl=False,
    return_altitude=(
        AltitudeParameter("RTL_ALT", dialect.MAV_PARAM_TYPE_INT32, 100.0),  # centimeters, up to 4.6
        AltitudeParameter("RTL_ALT_M", dialect.MAV_PARAM_TYPE_REAL32, 1.0),  # meters, from 4.7
    ),
    setpoint_memory_s=3.0,
)

# HEARTBEAT.autopilot -> flavor.
FLAVORS: Mapping[int, Flavor] = MappingProxyType({dialect.MAV_AUTOPILOT_ARDUPILOTMEGA: ARDUPILOT})


def known_flavors() -> str:
    """The names of all rows, for an error's "allowed is"."""
    return ", ".join(flavor.name for flavor in FLAVORS.values())
