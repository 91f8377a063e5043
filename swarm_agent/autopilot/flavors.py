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
        arms_in: the mode to arm and take off from. climbs_in: every custom_mode it may be in until its climb is over.
        guided_needs_setpoints: it enters `guided`, and stays there, only while setpoints come.
        lapses_into: every custom_mode in which it waits in the air when nobody has been heard; no person chose it.
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
    arms_in: Mode
    climbs_in: frozenset[int]
    ends_flight: frozenset[int]
    lapses_into: frozenset[int]
    mode_names: Mapping[int, str]
    guided_needs_setpoints: bool
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
    arms_in=Mode("GUIDED", 4, (4.0, 0.0)),
    climbs_in=frozenset({4}),
    ends_flight=frozenset({6, 9, 21, 27}),
    lapses_into=frozenset({17}),  # BRAKE: what FS_GCS_ENABLE 7 does
    mode_names=ARDUCOPTER_MODES,
    guided_needs_setpoints=False,
    takeoff_is_amsl=False,
    return_altitude=(
        AltitudeParameter("RTL_ALT", dialect.MAV_PARAM_TYPE_INT32, 100.0),  # centimeters, up to 4.6
        AltitudeParameter("RTL_ALT_M", dialect.MAV_PARAM_TYPE_REAL32, 1.0),  # meters, from 4.7
    ),
    setpoint_memory_s=3.0,
)


def _px4_mode(name: str, main: int, sub: int = 0) -> Mode:
    """PX4 counts main modes in the third byte of custom_mode, and AUTO's sub modes in the fourth."""
    return Mode(name, main << 16 | sub << 24, (float(main), float(sub)))


# PX4 px4_custom_mode.h, in PX4's and MAVSDK's words.
PX4_MODES = {
    mode.name: mode
    for mode in (
        _px4_mode("MANUAL", 1),
        _px4_mode("ALTCTL", 2),
        _px4_mode("POSCTL", 3),
        _px4_mode("READY", 4, 1),
        _px4_mode("TAKEOFF", 4, 2),
        _px4_mode("HOLD", 4, 3),
        _px4_mode("MISSION", 4, 4),
        _px4_mode("RTL", 4, 5),
        _px4_mode("LAND", 4, 6),
        _px4_mode("FOLLOW_ME", 4, 8),
        _px4_mode("PRECLAND", 4, 9),
        _px4_mode("ACRO", 5),
        _px4_mode("OFFBOARD", 6),
        _px4_mode("STABILIZED", 7),
    )
}


def _px4_customs(*names: str) -> frozenset[int]:
    return frozenset(PX4_MODES[name].custom_mode for name in names)


PX4 = Flavor(
    name="px4",
    guided=PX4_MODES["OFFBOARD"],
    homing=PX4_MODES["RTL"],
    landing=PX4_MODES["LAND"],
    arms_in=PX4_MODES["HOLD"],
    climbs_in=_px4_customs("HOLD", "TAKEOFF", "OFFBOARD"),
    ends_flight=_px4_customs("RTL", "LAND", "PRECLAND"),
    lapses_into=_px4_customs("HOLD", "POSCTL"),  # COM_OBL_RC_ACT: hold, or position mode with centered sticks
    mode_names=MappingProxyType({mode.custom_mode: name for name, mode in PX4_MODES.items()}),
    guided_needs_setpoints=True,
    takeoff_is_amsl=True,
    return_altitude=(AltitudeParameter("RTL_RETURN_ALT", dialect.MAV_PARAM_TYPE_REAL32, 1.0),),
    setpoint_memory_s=1.0,  # COM_OF_LOSS_T
)

# HEARTBEAT.autopilot -> flavor.
FLAVORS: Mapping[int, Flavor] = MappingProxyType(
    {dialect.MAV_AUTOPILOT_ARDUPILOTMEGA: ARDUPILOT, dialect.MAV_AUTOPILOT_PX4: PX4}
)


def known_flavors() -> str:
    """The names of all rows, for an error's "allowed is"."""
    return ", ".join(flavor.name for flavor in FLAVORS.values())
