"""Who may say and hear what on a secured network. What is not in these tables is denied to everybody.

An agent speaks by its own radio and of itself alone, hears its own receiver and its own cues, and answers people. In
the field it hears every radio, and still speaks by its own alone: behind the router, and from radio to radio. The
recorder hears the truth and says how far it has got. The operator sees who is there, and gives orders. A name is that
of a certificate (`comms.credentials`), not what a frame says of itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from comms.credentials import OPERATOR, Credentials, agents_named
from comms.keys import EVERYBODY_OF_ANY_MISSION, FLIGHT, RECORDER, WORLD, Keys


class Deed(Enum):
    """What one may do at a key: what passes from it to the router, and what from the router to it."""

    SAY = (("put",), ())
    KNOW_LISTENERS = ((), ("declare_subscriber",))  # without, nothing is sent: a publisher waits for listeners
    HEAR = (("declare_subscriber",), ("put",))
    BE_THERE = (("liveliness_token",), ())
    WATCH = (("declare_liveliness_subscriber", "liveliness_query"), ("liveliness_token", "reply"))
    ANSWER = (("declare_queryable", "reply"), ("query",))
    ASK = (("query",), ("declare_queryable", "reply"))


Rights = Sequence[tuple[Deed, Sequence[str]]]


class Place(Enum):
    """Where a gate stands, and what passes it."""

    AIR = "air"  # the router of a mission whose air carries every frame
    FIELD = "field"  # the router of a mission whose agents hear each other through it
    RADIO = "radio"  # an agent's own radio, which its mates reach directly
    BOARD = "board"  # the router of an agent without a world, on its own computer


@dataclass(frozen=True, slots=True)
class Gate:
    """What a session needs to know to let others in.

    Attributes:
        credentials: its own. keys: of its mission. names: whom it knows; nobody else may say or hear anything.
        place: where it stands.
    """

    credentials: Credentials
    keys: Keys
    names: tuple[str, ...]
    place: Place = Place.AIR

    def access_control(self) -> dict[str, Any]:
        """The section `access_control` of zenoh's configuration."""
        granted = {name: list(_rules(name, rights(self.keys, name, self.place))) for name in self.names}
        granted = {name: rules for name, rules in granted.items() if rules}  # zenoh takes no empty list
        return {
            "enabled": True,
            "default_permission": "deny",
            "rules": [rule for rules in granted.values() for rule in rules],
            "subjects": [{"id": name, "cert_common_names": [name]} for name in granted],
            "policies": [
                {"rules": [rule["id"] for rule in rules], "subjects": [name]} for name, rules in granted.items()
            ],
        }


def rights(keys: Keys, name: str, place: Place = Place.AIR) -> Rights:
    """What `name` may do there; nothing if it is not a name of a swarm."""
    if place is Place.RADIO:
        return _mates(keys, agents_named(name))
    if place is Place.BOARD:
        return _operator(keys) if name == OPERATOR else _detectors(keys, agents_named(name))
    if name == RECORDER:
        return _recorder(keys)
    if name == OPERATOR:
        return _operator(keys)
    return _agents(keys, agents_named(name), [keys.every_tx] if place is Place.FIELD else [])


def _agents(keys: Keys, uids: Sequence[int], also_heard: Sequence[str]) -> Rights:
    if not uids:
        return ()
    return (
        (Deed.SAY, [key for uid in uids for key in (keys.tx(uid), keys.done(uid))]),
        (Deed.KNOW_LISTENERS, [keys.every_tx, keys.every_done]),
        (Deed.HEAR, [*also_heard, *(key for uid in uids for key in (keys.rx(uid), keys.cue(uid)))]),
        (Deed.BE_THERE, [keys.alive(uid) for uid in uids]),
        (Deed.WATCH, [keys.alive(WORLD), keys.alive(FLIGHT)]),
        (Deed.ANSWER, [keys.every_command(uid) for uid in uids]),
    )


def _mates(keys: Keys, uids: Sequence[int]) -> Rights:
    if not uids:
        return ()
    return (
        (Deed.SAY, [keys.tx(uid) for uid in uids]),
        (Deed.KNOW_LISTENERS, [keys.every_tx]),
        (Deed.HEAR, [keys.every_tx]),
    )


def _detectors(keys: Keys, uids: Sequence[int]) -> Rights:
    if not uids:
        return ()
    return (
        (Deed.SAY, [keys.sight(uid) for uid in uids]),
        (Deed.KNOW_LISTENERS, [keys.sight(uid) for uid in uids]),
    )


def _recorder(keys: Keys) -> Rights:
    return (
        (Deed.SAY, [keys.kept]),
        (Deed.KNOW_LISTENERS, [keys.kept]),
        (Deed.HEAR, [keys.truth]),
        (Deed.BE_THERE, [keys.every_recorder]),
        (Deed.WATCH, [keys.alive(WORLD), keys.alive(FLIGHT)]),
    )


def _operator(keys: Keys) -> Rights:
    return (
        (Deed.WATCH, [EVERYBODY_OF_ANY_MISSION]),
        (Deed.ASK, [keys.every_order]),
    )


def _rules(name: str, rights: Rights) -> Iterable[dict[str, Any]]:
    for deed, key_exprs in rights:
        for flow, messages in zip(("ingress", "egress"), deed.value, strict=True):
            if messages:
                yield {
                    "id": f"{name} {deed.name} {flow}",
                    "permission": "allow",
                    "flows": [flow],
                    "messages": list(messages),
                    "key_exprs": list(key_exprs),
                }
