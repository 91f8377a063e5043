"""Power-up to armable: what an autopilot says and knows at each moment, scaled to the time it is to take."""

from __future__ import annotations

from bisect import bisect_right
from typing import NamedTuple


class Stage(NamedTuple):
    """What the autopilot knows from a moment on.

    Attributes:
        from_s: real seconds after power-on. ekf_flags: EKF_STATUS_REPORT.flags.
        gps_fix, satellites: GPS_RAW_INT. gps_wrong: the first fix is half a degree off.
        origin: the EKF has its origin, home is set. position: the EKF uses GPS, LOCAL_POSITION_NED flows.
        complaints: reasons not to arm.
    """

    from_s: float
    ekf_flags: int
    complaints: tuple[str, ...] = ()
    booting: bool = False
    gps_fix: int = 0
    satellites: int = 0
    gps_wrong: bool = False
    origin: bool = False
    position: bool = False


class Script(NamedTuple):
    """How a kind of autopilot boots: its texts and stages, in order, and when it is ready to arm."""

    ready_s: float
    texts: tuple[tuple[float, str], ...]
    stages: tuple[Stage, ...]


class Boot:
    """One vehicle's boot sequence, scaled to `boot_s`. It only ever goes forward."""

    def __init__(self, script: Script, *, boot_s: float, field_elevation_m: float) -> None:
        scale = boot_s / script.ready_s
        self._texts = [(at_s * scale, text.format(field_elevation_m=field_elevation_m)) for at_s, text in script.texts]
        self._stages = script.stages
        self._starts_s = [stage.from_s * scale for stage in script.stages]
        self.restart()

    def restart(self) -> None:
        """Power-on, again."""
        self._said = 0
        self.stage = self._stages[0]

    def advance(self, age_s: float) -> list[str]:
        """Go on to `age_s` seconds after power-on; the texts that are due, in order."""
        if self._said == len(self._texts):
            return []
        self.stage = self._stages[max(0, bisect_right(self._starts_s, age_s + 1e-9) - 1)]
        due: list[str] = []
        while self._said < len(self._texts) and self._texts[self._said][0] <= age_s + 1e-9:
            due.append(self._texts[self._said][1])
            self._said += 1
        return due
