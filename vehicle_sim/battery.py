"""The battery: a charge that the current empties.

By default its voltage stays put, as that of the recorded ArduCopter 4.5.5 SITL does. With a capacity of its own it
falls with the charge and sags with the current, and when it is empty the motors stop.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass

MAH_PER_AMPERE_SECOND = 1.0 / 3.6
IDLE_SHARE = 0.16  # armed on the ground, of the hover current (recorded: 4.6 A of 28.1 A)
RESISTANCE_OHM = 0.012  # of a usual pack of three cells and some ampere hours

# (charge, voltage) of a lithium-polymer cell at rest, as shares of a full one's: 3.27 V empty, 4.20 V full.
DISCHARGE: tuple[tuple[float, float], ...] = (
    (0.0, 0.779), (0.05, 0.860), (0.1, 0.879), (0.2, 0.888), (0.3, 0.898), (0.4, 0.905), (0.5, 0.914), (0.6, 0.921),
    (0.7, 0.940), (0.8, 0.957), (0.9, 0.979), (1.0, 1.0),
)  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Battery:
    """A vehicle's battery.

    Attributes:
        capacity_mah: charge when full. voltage_v: as the autopilot reports it.
        hover_current_a: drawn while hovering in still air (recorded: 28.1 A).
    """

    capacity_mah: float = 5000.0
    voltage_v: float = 12.6
    hover_current_a: float = 28.0

    def __post_init__(self) -> None:
        for name in ("capacity_mah", "voltage_v", "hover_current_a"):
            if not 0.0 < getattr(self, name) < 1e6:
                raise ValueError(f"battery.{name} is above 0 and below 1e6, not {getattr(self, name)}")

    def voltage_in_hover(self, charge: float) -> float:
        """The voltage that is measured in hover with this share of the charge left."""
        return self.voltage_v * voltage_at(charge) - self.hover_current_a * RESISTANCE_OHM


class Charge:
    """What is left in one battery.

    Attributes:
        consumed_mah: drawn since power-on.
    """

    def __init__(self, battery: Battery) -> None:
        self.battery = battery
        self.current_a = 0.0
        self.consumed_mah = 0.0
        self._fixed_v = battery.voltage_v
        self._capacity_mah = 0.0
        self._left_mah = 0.0

    def supply(self, *, voltage_v: float, capacity_mah: float) -> None:
        """Another battery: at rest it has `voltage_v`. Capacity 0: for ever; else that voltage says how full it is."""
        self._fixed_v = voltage_v
        self._capacity_mah = capacity_mah
        self._left_mah = capacity_mah * charge_at(voltage_v / self.battery.voltage_v)

    def drain(self, *, effort: float, dt_s: float) -> None:
        """Draw for `dt_s`: effort 0 is disarmed, IDLE_SHARE idling, 1 hovering; thrust to the power 1.5 beyond."""
        self.current_a = self.battery.hover_current_a * effort
        drawn_mah = self.current_a * dt_s * MAH_PER_AMPERE_SECOND
        self.consumed_mah += drawn_mah
        self._left_mah = max(0.0, self._left_mah - drawn_mah)

    @property
    def empty(self) -> bool:
        return self._capacity_mah > 0.0 and self._left_mah <= 0.0

    @property
    def resting_v(self) -> float:
        """The voltage without the current."""
        if self._capacity_mah <= 0.0:
            return self._fixed_v
        return self.battery.voltage_v * voltage_at(self._left_mah / self._capacity_mah)

    @property
    def voltage_v(self) -> float:
        """The voltage as it is measured now."""
        sag_v = self.current_a * RESISTANCE_OHM if self._capacity_mah > 0.0 else 0.0
        return max(0.0, self.resting_v - sag_v)


def voltage_at(charge: float) -> float:
    """Share of the full voltage at rest, for a share of the charge."""
    return _interpolated(DISCHARGE, charge)


def charge_at(voltage: float) -> float:
    """Share of the charge, for a share of the full voltage at rest."""
    return _interpolated(tuple((v, c) for c, v in DISCHARGE), voltage)


def _interpolated(table: tuple[tuple[float, float], ...], x: float) -> float:
    """Straight lines through the table, and its ends beyond them."""
    right = bisect_left(table, (x,))
    if right == 0:
        return table[0][1]
    if right == len(table):
        return table[-1][1]
    (x0, y0), (x1, y1) = table[right - 1], table[right]
    return y0 + (x - x0) / (x1 - x0) * (y1 - y0)
