"""What the agent wants of its vehicle: one value each tick."""

from __future__ import annotations

import msgspec


class Prepare(msgspec.Struct, frozen=True):
    """Get ready: connect, arm, climb to the layer, and hold there."""


class Fly(msgspec.Struct, frozen=True):
    """Fly with this horizontal velocity (east, north; m/s), on the own layer. Until that is reached: `Prepare`."""

    velocity_enu_m_s: tuple[float, float]


class Return(msgspec.Struct, frozen=True):
    """Fly home, land there, disarm. Once begun it is not taken back."""


class Land(msgspec.Struct, frozen=True):
    """Land on the spot, disarm. Once begun it is not taken back."""


Intent = Prepare | Fly | Return | Land
