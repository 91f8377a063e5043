"""What the agents of a mission hear of each other."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from missions.mission.part import Part, Positive


class Radio(Part):
    """What agents hear of each other."""

    mode: Literal["sim", "ideal"] = "sim"
    """`sim`: range, loss and latency; `ideal`: range alone."""
    range_m: Positive = 20.0
    """How far, horizontally, a frame is heard."""
    loss: Annotated[float, Field(ge=0, le=1)] = 0.0
    """Probability that a frame does not reach a receiver in range."""
    latency_s: Annotated[float, Field(ge=0, le=60)] = 0.0
    """Delay of a frame; none is heard before the next tick."""
