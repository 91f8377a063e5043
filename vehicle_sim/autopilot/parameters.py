"""The parameters of an autopilot of any flavor.

A range is advice for ground stations: what a parameter's C type can hold is stored, and whoever reads it keeps to what
is possible.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib.resources import files
from math import copysign, isfinite
from typing import NamedTuple

from vehicle_sim.flight import FlightLimits
from vehicle_sim.vehicle import VehicleConfig

TYPES = {"INT8": 2, "INT16": 4, "INT32": 6, "REAL32": 9}  # MAV_PARAM_TYPE
REAL32 = TYPES["REAL32"]
HOLDS = {2: (-128, 127), 4: (-32768, 32767), 6: (-(2**31), 2**31 - 128), REAL32: (-3.4e38, 3.4e38)}
ROUNDING = 0.01  # added before a float is cut to an integer, as ArduPilot does


class Row(NamedTuple):
    """One parameter.

    Attributes:
        type: MAV_PARAM_TYPE. lowest, highest: what makes sense, if that is known.
        status: "acts", "stored" (for ground stations alone) or "read-only" (answers with what it is).
    """

    name: str
    type: int
    default: float
    lowest: float | None
    highest: float | None
    unit: str
    status: str
    doc: str

    @property
    def read_only(self) -> bool:
        return self.status == "read-only"


def read_table(package: str) -> tuple[Row, ...]:
    """The rows of the `parameters.csv` beside a package, in the order in which they are listed."""
    text = (files(package) / "parameters.csv").read_text(encoding="utf-8")
    return tuple(
        Row(
            name=line["name"],
            type=TYPES[line["type"]],
            default=float(line["default"]),
            lowest=float(line["lowest"]) if line["lowest"] else None,
            highest=float(line["highest"]) if line["highest"] else None,
            unit=line["unit"],
            status=line["status"],
            doc=line["doc"],
        )
        for line in csv.DictReader(text.splitlines())
    )


class Alias(NamedTuple):
    """Another name of a parameter: `name` is `scale` times its value, plus `offset`."""

    name: str
    scale: float = 1.0
    offset: float = 0.0


Listener = Callable[[], None]


class Catalog:
    """The parameters of one flavor of autopilot.

    Attributes:
        rows: in the order of the list. index: where a name is in it.
        aliases: other names that a ground station may use.
        meanings: for a row's name, what else it sets: (a name of ArduCopter that shared parts read, its scale, offset).
        given: names of ArduCopter that shared parts read, and that this flavor has no row for.
    """

    def __init__(
        self,
        rows: tuple[Row, ...],
        *,
        aliases: Mapping[str, Alias] | None = None,
        shared: Mapping[str, Alias] | None = None,
        given: Mapping[str, float] | None = None,
    ) -> None:
        self.rows = rows
        self.index = {row.name: index for index, row in enumerate(rows)}
        self.aliases = aliases or {}
        self.given = given or {}
        self.meanings: dict[str, list[tuple[str, Alias]]] = {}
        for name, alias in (shared or {}).items():
            self.meanings.setdefault(alias.name, []).append((name, alias))


def surroundings(config: VehicleConfig) -> dict[str, float]:
    """The SIM_* parameters of what is around an autopilot."""
    return {
        "SIM_BATT_VOLTAGE": config.battery.voltage_v,
        "SIM_WIND_SPD": config.wind.speed_m_s,
        "SIM_WIND_DIR": config.wind.from_deg % 360.0,
        "SIM_WIND_TURB": config.wind.gust_m_s,
    }


class Parameters:
    """One vehicle's parameters: `parameters["RTL_ALT"]` is the stored value.

    Shared parts of the autopilots read them by ArduCopter's names; a catalog says what those are in another flavor.
    """

    def __init__(self, catalog: Catalog, values: Mapping[str, float]) -> None:
        self.catalog = catalog
        self._listeners: dict[str, Listener] = {}
        self._values = {row.name: row.default for row in catalog.rows} | dict(catalog.given) | dict(values)
        for name in catalog.meanings:
            self._mean(name)

    def __getitem__(self, name: str) -> float:
        return self._values[name]

    def on_change(self, prefixes: tuple[str, ...], listener: Listener) -> None:
        """Call `listener` whenever a parameter whose name begins with one of `prefixes` is stored."""
        for name in self._values:
            if name.startswith(prefixes):
                self._listeners[name] = listener

    def store(self, name: str, value: float) -> bool:
        """Store a finite `value` as its C type takes it (cut, clamped). False if it was not: read-only."""
        row = self.catalog.rows[self.catalog.index[name]]
        if row.read_only or not isfinite(value):
            return False
        lowest, highest = HOLDS[row.type]
        if row.type != REAL32:
            value = int(max(lowest, min(highest, value + copysign(ROUNDING, value))))
        self._put(name, float(max(lowest, min(highest, value))))
        self._mean(name)
        return True

    def suffer(self, name: str, value: float) -> None:
        """Let something break that no row of this flavor breaks: a SIM_* parameter by ArduCopter's name."""
        self._put(name, value)

    def tell(self, name: str, value: float) -> None:
        """Let a read-only parameter say what it is."""
        self._values[name] = float(value)

    def _put(self, name: str, value: float) -> None:
        self._values[name] = value
        if name in self._listeners:
            self._listeners[name]()

    def _mean(self, name: str) -> None:
        """Set what `name` is for the shared parts."""
        for shared, alias in self.catalog.meanings.get(name, ()):
            self._put(shared, alias.scale * self._values[name] + alias.offset)

    def limits(self, limits: FlightLimits) -> FlightLimits:
        """`limits` with what the parameters say; a value no vehicle can have is brought to the nearest it can."""
        return replace(
            limits,
            speed_m_s=_within(self["WPNAV_SPEED"] / 100.0, 0.1, 100.0),
            climb_m_s=_within(self["WPNAV_SPEED_UP"] / 100.0, 0.1, 100.0),
            descent_m_s=_within(self["WPNAV_SPEED_DN"] / 100.0, 0.1, 100.0),
            acceleration_m_s2=_within(self["WPNAV_ACCEL"] / 100.0, 0.5, 100.0),
            tilt_deg=_within(self["ANGLE_MAX"] / 100.0, 10.0, 80.0),
        )


LIMIT_NAMES = ("ANGLE_MAX", "PILOT_SPEED", "WPNAV_ACCEL", "WPNAV_SPEED")  # the beginnings of their names


def _within(value: float, lowest: float, highest: float) -> float:
    return max(lowest, min(highest, value))
