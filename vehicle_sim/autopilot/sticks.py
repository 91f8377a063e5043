"""A pilot's sticks, as RC_CHANNELS_OVERRIDE and MANUAL_CONTROL set them. They time out, and then the throttle is at its
bottom: what an ArduCopter SITL sees of a radio that nobody holds (recorded: channels 1500, 1500, 1000, 1500).
"""

from __future__ import annotations

from typing import Any, NamedTuple

MIDDLE_US, HALF_SPAN_US = 1500.0, 500.0
IGNORED_US, RELEASED_US = 65535, 0
NO_AXIS = 32767  # MANUAL_CONTROL: this axis is not there
TIMEOUT_S = 3.0  # RC_OVERRIDE_TIME
DEADBAND = 0.1  # THR_DZ, of the throttle's way on either side of its middle


class Sticks(NamedTuple):
    """Right, forward and clockwise from -1 to 1; throttle from 0 (bottom) to 1."""

    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0
    throttle: float = 0.0

    @property
    def centered(self) -> bool:
        return self.roll == 0.0 and self.pitch == 0.0

    def climb(self) -> float:
        """What the throttle asks for outside its dead band: -1 (down) to 1 (up), 0 inside."""
        off_middle = 2.0 * self.throttle - 1.0
        beyond = max(0.0, abs(off_middle) - 2.0 * DEADBAND) / (1.0 - 2.0 * DEADBAND)
        return beyond if off_middle > 0.0 else -beyond


NO_RADIO = Sticks()


def overridden(held: Sticks, message: Any) -> Sticks:
    """RC_CHANNELS_OVERRIDE: the first four channels; 65535 keeps what is held, 0 gives a channel back to the radio."""
    widths_us = (message.chan1_raw, message.chan2_raw, message.chan3_raw, message.chan4_raw)
    roll, backward, throttle, yaw = (
        old if width == IGNORED_US else rest if width == RELEASED_US else _from_width(width)
        for width, old, rest in zip(
            widths_us, (held.roll, -held.pitch, 2.0 * held.throttle - 1.0, held.yaw), (0.0, 0.0, -1.0, 0.0), strict=True
        )
    )
    return Sticks(roll, -backward, yaw, 0.5 * (throttle + 1.0))


def manual(held: Sticks, message: Any) -> Sticks:
    """MANUAL_CONTROL: x forward, y right, r clockwise, z the throttle from 0 to 1000; 32767 keeps what is held."""
    asked = [
        old if axis == NO_AXIS else max(-1.0, min(1.0, axis / 1000.0))
        for axis, old in zip(
            (message.y, message.x, message.r, message.z), (held.roll, held.pitch, held.yaw, held.throttle), strict=True
        )
    ]
    return Sticks(asked[0], asked[1], asked[2], max(0.0, asked[3]))


def _from_width(width_us: int) -> float:
    return max(-1.0, min(1.0, (width_us - MIDDLE_US) / HALF_SPAN_US))
