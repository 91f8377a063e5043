"""The battery: a charge that the current empties. Its voltage stays put, as in the recorded ArduCopter 4.5.5 SITL."""

from __future__ import annotations

from dataclasses import dataclass

MAH_PER_AMPERE_SECOND = 1.0 / 3.6
IDLE_SHARE = 0.16  # armed on the ground, of the hover current (recorded: 4.6 A of 28.1 A)


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


class Charge:
    """What is left in one battery."""

    def __init__(self, battery: Battery) -> None:
        self.battery = battery
        self.current_a = 0.0
        self.consumed_mah = 0.0

    def drain(self, *, effort: float, dt_s: float) -> None:
        """Draw for `dt_s`: effort 0 is disarmed, IDLE_SHARE idling, 1 hovering; thrust to the power 1.5 beyond."""
        self.current_a = self.battery.hover_current_a * effort
        self.consumed_mah += self.current_a * dt_s * MAH_PER_AMPERE_SECOND

    @property
    def remaining(self) -> float:
        """The share that is left, 0 to 1."""
        return max(0.0, 1.0 - self.consumed_mah / self.battery.capacity_mah)
