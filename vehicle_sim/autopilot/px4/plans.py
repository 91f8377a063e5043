"""What a PX4 takes as a plan, and how it asks for it: MISSION_REQUEST_INT, again after 250 ms, for 5 s."""

from __future__ import annotations

from math import isfinite, isinf, isnan

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.plans import commands
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.plans.rules import PlanRules
from vehicle_sim.autopilot.plans.store import FENCE, MISSION, RALLY, Answer

PLACES = frozenset(
    {
        commands.WAYPOINT,
        commands.LOITER_UNLIMITED,
        commands.LOITER_TIME,
        commands.LAND,
        commands.TAKEOFF,
        commands.LOITER_TO_ALTITUDE,
        commands.ROI_LOCATION,
        commands.ROI,
    }
)
# What it does without a place, and what is kept for the hardware that this vehicle has not.
OTHERS = frozenset(
    {
        commands.RETURN,
        commands.DELAY,
        commands.JUMP,
        commands.CHANGE_SPEED,
        commands.SET_HOME,
        commands.LAND_START,
        commands.ROI_NONE,
        183, 187, 203, 205, 206, 211, 214, 530, 531, 532, 1000, 1001, 2000, 2001, 2003, 2500, 2501,
    }
)  # fmt: skip
PLACE_FRAMES = frozenset({0, 3, 5, 6})  # MAV_FRAME: above the sea or home
HIGHEST_M = 32767.0


def _accepts(item: Item, count: int) -> Answer:
    """NaN is legal wherever a number may be left open."""
    if item.command not in PLACES | OTHERS:
        return Answer.UNSUPPORTED
    for index, value in enumerate(item.params):
        if isinf(value):
            return Answer(Answer.INVALID_PARAM1 + index)
    if item.command == commands.JUMP:
        return Answer.ACCEPTED if 0.0 <= item.param1 < count else Answer.ERROR
    if item.command in OTHERS:
        return Answer.ACCEPTED
    if item.frame not in PLACE_FRAMES:
        return Answer.UNSUPPORTED_FRAME
    if abs(item.x) > 900_000_000:
        return Answer.INVALID_PARAM5_X
    if abs(item.y) > 1_800_000_000:
        return Answer.INVALID_PARAM6_Y
    return Answer.ACCEPTED if isnan(item.z) or abs(item.z) <= HIGHEST_M else Answer.INVALID_PARAM7


def _flown(item: Item) -> Item:
    """What is left open counts as 0."""
    return Item(*(value if isfinite(value) else 0.0 for value in item))  # type: ignore[arg-type]


PX4_PLANS = PlanRules(
    kinds=(
        MISSION._replace(
            most=2000, total=None, accepts=_accepts, received="", missing=Answer.ERROR, home_first=False, flown=_flown
        ),
        FENCE._replace(most=64, total=None, missing=Answer.ERROR),
        RALLY._replace(most=32, total=None, received="", missing=Answer.ERROR),
    ),
    ask=dialect.MAVLink_mission_request_int_message,
    ask_again_s=0.25,
    give_up_s=5.0,
    strict=False,
    first=0,
    talks=False,
    starts_over=True,
)
