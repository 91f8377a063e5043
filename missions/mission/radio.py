"""What the agents of a mission hear of each other."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from comms.endpoint import place_of
from missions.mission.part import Allowed, Part, Positive


def _endpoint(text: str) -> str:
    if not text.startswith("tcp/") or place_of(text) is None:
        raise ValueError("not an endpoint")
    return text


Endpoint = Annotated[str, Field(max_length=300), AfterValidator(_endpoint)]
ENDPOINTS = "a list with tcp/ADDRESS:PORT for each agent"


class Radio(Part):
    """What agents hear of each other."""

    mode: Literal["sim", "ideal", "field"] = "sim"
    """`sim`: range, loss and latency; `ideal`: range alone; `field`: none is simulated, real radios carry frames."""
    range_m: Positive = 20.0
    """How far, horizontally, a frame is heard; in the field, how far one is expected to be heard."""
    endpoints: Annotated[tuple[Endpoint, ...], Field(strict=False), Allowed(ENDPOINTS)] = ()
    """In the field: where the agents' radios are reached by each other, by agent. Agents of one process share one.
    None: they hear each other through the world."""
    loss: Annotated[float, Field(ge=0, le=1)] = 0.0
    """Probability that a frame does not reach a receiver in range."""
    latency_s: Annotated[float, Field(ge=0, le=60)] = 0.0
    """Delay of a frame; none is heard before the next tick. In the field, the delay to be expected."""
