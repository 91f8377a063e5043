"""The link model: whether one agent's frame reaches another. Scalar rules that missions and studies share."""

from __future__ import annotations

from math import ceil

from comms.chance import LINK_LOSS, draw

_PAIR = 65_536  # one key per ordered pair of agents


def in_range(dx_m: float, dy_m: float, range_m: float) -> bool:
    """Section 3: a robot receives what is sent by any other robot closer than the communication range r_c."""
    return dx_m * dx_m + dy_m * dy_m <= range_m * range_m


def survives(seed: int, tick: int, src: int, dst: int, loss: float) -> bool:
    """Whether the frame that `src` sent at `tick` escapes random loss on its way to `dst` (loss: 0 to 1)."""
    return loss <= 0.0 or draw(seed, tick, src * _PAIR + dst, LINK_LOSS) >= loss


def delay_ticks(latency_s: float, tick_s: float) -> int:
    """After how many ticks a frame is heard: at least one, since everybody decides from the same state."""
    return max(1, ceil(latency_s / tick_s - 1e-9))
