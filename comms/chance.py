"""Chance without hidden state: every draw is a hash of (seed, tick, who, what for).

The same four numbers give the same draw in every process and every driver, so a run repeats exactly and nobody's draws
shift when somebody else draws more. Plain integer arithmetic that stays inside 64 bits: it reads the same compiled.
"""

from __future__ import annotations

# What a draw is for: the last key, so that two uses in one tick never share a number.
LINK_LOSS = 1
EXPLORE_TURN = 2
TARGET_TURN = 3
TARGET_ANGLE = 4
PLACE_AGENT = 5
PLACE_TARGET = 6
GUST = 7
START_HEADING = 9
IDENTITY_ERROR = 10
GPS_NOISE = 11
BARO_NOISE = 12
COMPASS_NOISE = 13
IMU_NOISE = 14
LINK_BURST = 15


def mix(x: int) -> int:
    """A 32-bit finalizer with full avalanche ("lowbias32"); products stay below 2**63."""
    x = x & 0xFFFFFFFF
    x = ((x ^ (x >> 16)) * 0x7FEB352D) & 0xFFFFFFFF
    x = ((x ^ (x >> 15)) * 0x846CA68B) & 0xFFFFFFFF
    return x ^ (x >> 16)


def draw(seed: int, tick: int, who: int, purpose: int) -> float:
    """A uniform number in [0, 1), the same for the same four keys (each taken modulo 2**32)."""
    return mix(mix(mix(mix(seed) ^ (tick & 0xFFFFFFFF)) ^ (who & 0xFFFFFFFF)) ^ (purpose & 0xFFFFFFFF)) / 4294967296.0
