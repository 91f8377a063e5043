"""The keys of a mission as the model has them: which keys a section takes, and in words what each allows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from types import NoneType
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import Tag
from pydantic.fields import FieldInfo

from missions.mission import Allowed, Mission, Part
from missions.problems import Path, any_of, shown

# The tag under which a section that comes in one kind only is listed among its variants.
_ONLY = None


@dataclass(frozen=True, slots=True)
class Key:
    """One key of the model: its path, the section it stands in, and its field; no field if there is no such key."""

    path: Path
    section: type[Part]
    field: FieldInfo | None


def find_key(location: Sequence[int | str], root: type[Part] = Mission) -> Key:
    """The key at pydantic's `location`, which has, unlike the key's path, the tag of every variant on its way.

    Inside a value that is no section (a list of numbers, a mapping of words) the field stays that of the value.
    """
    section: type[Part] = root
    inner: Mapping[str | None, type[Part]] = {_ONLY: root}
    field: FieldInfo | None = None
    path: Path = ()
    for step in location:
        if not inner or isinstance(step, int):
            path = (*path, str(step))
            continue
        if step in inner:
            inner = {_ONLY: inner[step]}
            continue
        section = inner.get(_ONLY, section)
        path = (*path, step)
        field = section.model_fields.get(step)
        inner = variants(field) if field else {}
    return Key(path, section, field)


def variants(field: FieldInfo) -> dict[str | None, type[Part]]:
    """The kinds of section a field takes, or a list of them, by tag; none for a plain value."""
    annotation = field.annotation
    if get_origin(annotation) is tuple:
        annotation = get_args(annotation)[0]
        if get_origin(annotation) is Annotated:
            annotation = get_args(annotation)[0]
    if isinstance(annotation, type) and issubclass(annotation, Part):
        return {_ONLY: annotation}
    tagged = [get_args(choice) for choice in get_args(annotation)]
    return {parts[1].tag: parts[0] for parts in tagged if len(parts) == 2 and isinstance(parts[1], Tag)}


def chooser(field: FieldInfo) -> tuple[str, str] | None:
    """The key that says which variant of a section is meant, and what it allows; None if there is but one."""
    kinds = variants(field)
    if not kinds or _ONLY in kinds:
        return None
    # By custom a variant's first key is the one that tells it from the others.
    fields = [next(iter(kind.model_fields.items())) for kind in kinds.values()]
    return fields[0][0], any_of(word for _, choice in fields for word in get_args(choice.annotation))


def every_key(section: type[Part] = Mission, path: Path = ()) -> Iterator[Key]:
    """All keys of the model, section by section, those of every variant too."""
    for name, field in section.model_fields.items():
        yield Key((*path, name), section, field)
        for kind in variants(field).values():
            yield from every_key(kind, (*path, name))


def allowed(field: FieldInfo) -> str:
    """What a key allows, in words: "a whole number from 1 to 250"."""
    kinds = variants(field)
    if kinds:
        chosen = chooser(field)
        return f"a mapping with keys such as {next(iter(kinds[_ONLY].model_fields)) if chosen is None else chosen[0]}"
    said = _said(field)
    if said is not None:
        return said
    choices = [choice for choice in get_args(field.annotation) if choice is not NoneType]
    text = _allowed_value(choices[0] if _is_optional(field) else field.annotation, field.metadata)
    return f"{text}, or null" if _is_optional(field) else text


def is_list(field: FieldInfo) -> bool:
    """Whether a field takes a list of sections."""
    return bool(variants(field)) and get_origin(field.annotation) is tuple


def allowed_list(field: FieldInfo) -> str:
    """What such a list may be, in words; `allowed` tells of its parts."""
    return _said(field) or f"a list; each of it {allowed(field)}"


def _said(field: FieldInfo) -> str | None:
    return next((note.text for note in field.metadata if isinstance(note, Allowed)), None)


def _is_optional(field: FieldInfo) -> bool:
    return NoneType in get_args(field.annotation)


def _allowed_value(kind: Any, limits: Sequence[object]) -> str:
    if get_origin(kind) is Literal:
        return any_of(get_args(kind))
    if kind is bool:
        return "true or false"
    if kind in (str, FilePath):
        return "text"
    return ("a whole number" if kind is int else "a number") + _between(limits)


def _between(limits: Sequence[object]) -> str:
    least, above, most, below = (_limit(limits, name) for name in ("ge", "gt", "le", "lt"))
    if above is not None:
        return f" above {above}" if most is None else f" above {above}, at most {most}"
    if least is None:
        return ""
    if most is not None:
        return f" from {least} to {most}"
    return f", {least} or more" if below is None else f" from {least} to below {below}"


def _limit(limits: Sequence[object], name: str) -> str | None:
    return next((shown(getattr(limit, name)) for limit in limits if hasattr(limit, name)), None)
