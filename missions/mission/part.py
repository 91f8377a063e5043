"""What every section of a mission is made of: its base, and the numbers that several sections have."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field


@dataclass(frozen=True, slots=True)
class Allowed:
    """Says in words what a key allows, where its type cannot."""

    text: str


Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
# What a frame on the radio and an autopilot's local frame can hold, with room to spare.
Extent = Annotated[float, Field(gt=0, le=50_000)]
Span = Annotated[float, Field(ge=0, le=3600)]
NAME = "a word of letters, digits, '_', '.' and '-', at most 64 long, that starts with a letter or digit"
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.\-]{0,63}$"), Allowed(NAME)]


class Part(BaseModel):
    """A section of a mission: frozen, without unknown keys; a whole number may stand for a float, no more bends."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, use_attribute_docstrings=True
    )


def tag_by(key: str, tags: Mapping[str, str], *, required: bool = False) -> Callable[[Any], str | None]:
    """Which variant of a section is meant: `tags` of the value at `key`; the first, or none, if the key is absent."""
    default = None if required else next(iter(tags))

    def tag(section: Any) -> str | None:
        chosen = section.get(key, default) if isinstance(section, Mapping) else getattr(section, key, None)
        return tags.get(chosen) if isinstance(chosen, str) else None

    return tag
