"""When an agent must come home for its battery: by the charge, by the voltage, or because its autopilot says so.

    reserve = Reserve(ReserveConfig(share=0.2, voltage_v=10.85))
    reserve.spent(now_s, battery)      # once a tick; once True, it stays so

The charge that autopilots tell is what was not drawn yet. An old or a half-charged battery may be nearly empty with
much of that left: its voltage tells.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from comms.status import Event, Level

SAGS_S = 5.0  # under a heavy load, for a moment, a good battery has a low voltage too


class Battery(NamedTuple):
    """A battery as its vehicle tells: share left, 0 to 1, and voltage (None: unknown); whether it is called low."""

    share: float | None = None
    voltage_v: float | None = None
    is_low: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class ReserveConfig:
    """What must be left for the way home: a share of the charge, and a voltage in hover. None: it does not matter."""

    share: float | None = None
    voltage_v: float | None = None


class Reserve:
    """Watches one battery."""

    def __init__(self, config: ReserveConfig) -> None:
        self._config = config
        self._sagging_since_s: float | None = None
        self._spent = False
        self._events: list[Event] = []

    def spent(self, now_s: float, battery: Battery) -> bool:
        """Whether no more than the reserve is left, now or ever before."""
        why = self._shortage(now_s, battery)
        if why and not self._spent:
            self._spent = True
            self._events.append(Event(Level.ERROR, f"{why}: coming home"))
        return self._spent

    def take_events(self) -> tuple[Event, ...]:
        """What happened since the last call."""
        events = tuple(self._events)
        self._events.clear()
        return events

    def _shortage(self, now_s: float, battery: Battery) -> str:
        share, voltage_v = self._config.share, self._config.voltage_v
        sags = battery.voltage_v is not None and voltage_v is not None and battery.voltage_v < voltage_v
        if not sags:
            self._sagging_since_s = None
        elif self._sagging_since_s is None:
            self._sagging_since_s = now_s
        if battery.share is not None and share is not None and battery.share <= share:
            return f"battery at {battery.share:.0%}"
        if self._sagging_since_s is not None and now_s - self._sagging_since_s >= SAGS_S:
            return f"battery at {battery.voltage_v:.1f} V"
        return "its autopilot says that the battery is low" if battery.is_low else ""
