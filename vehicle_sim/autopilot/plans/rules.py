"""Where flavors of autopilots differ about plans."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.plans.store import KINDS, Kind


class PlanRules(NamedTuple):
    """How one flavor carries and flies plans.

    Attributes:
        kinds: mission, fence and rally points, in this order.
        ask: the message that asks for an item: (system, component, sequence number, kind) of it.
        ask_again_s, give_up_s: without an item that was asked for.
        strict: an item out of its order ends in an answer that says so; otherwise it is passed by.
        first: the index of the first item that is flown.
        talks: it says each step of a mission.
        starts_over: a mission that comes while none is flown begins at its beginning.
    """

    kinds: tuple[Kind, Kind, Kind]
    ask: Callable[[int, int, int, int], Any]
    ask_again_s: float
    give_up_s: float
    strict: bool
    first: int
    talks: bool
    starts_over: bool


# An upload asks with MISSION_REQUEST, as ArduCopter 4.5 does; item 0 is home.
ARDUCOPTER_PLANS = PlanRules(
    KINDS,
    dialect.MAVLink_mission_request_message,
    ask_again_s=1.0,
    give_up_s=8.0,
    strict=True,
    first=1,
    talks=True,
    starts_over=False,
)
